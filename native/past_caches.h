// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Writes past the caches: elsewhere a line of memory is read before it is written, which for poses of
// a thousand trees takes as long as to find them.
#pragma once

#include <stdint.h>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace {

#if defined(__SSE2__)

constexpr bool PASSES_CACHES = true;

// Copy numbers; other threads see them after `end_of_writes`.
inline void write_past_caches(const double *from, int64_t count, double *to) {
  if (count > 0 && reinterpret_cast<uintptr_t>(to) % 16 != 0) {
    *to++ = *from++;
    count--;
  }
  for (; count > 1; count -= 2, from += 2, to += 2) _mm_stream_pd(to, _mm_loadu_pd(from));
  if (count > 0) *to = *from;
}

inline void end_of_writes() { _mm_sfence(); }

#else

constexpr bool PASSES_CACHES = false;

inline void write_past_caches(const double *, int64_t, double *) {}

inline void end_of_writes() {}

#endif

}  // namespace
