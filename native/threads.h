// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Threads that share the work on trees. They sleep while there is none.
#pragma once

#include "memory.h"

namespace sway {

struct Threads;

// Does the work from a number on, in a room of its own.
typedef void (*Part)(void *work, size_t room, size_t first, size_t count);

// Number of processors that this process may use.
size_t processors();

// Take what `rooms` threads need and start all but one, the caller. Null where memory is short.
Threads *open_threads(Memory &memory, size_t rooms);

// Do all parts of some work. Where threads are missing, as in a process that was forked, they are
// started, and where they cannot be, others do their parts.
void share(Threads &threads, size_t count, Part part, void *work);

// End the threads; null is none.
void close_threads(Threads *threads);

}  // namespace sway
