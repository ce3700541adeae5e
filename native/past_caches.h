// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Writes past the caches: elsewhere a line of memory is read before it is written, which for poses of
// a thousand trees takes as long as to find them. They are made a few lines at a time while the next
// tree is placed, as memory takes them more slowly than they come.
#pragma once

#include <stdint.h>

#include "memory.h"

#if defined(__AVX512F__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace sway {

#if defined(__SSE2__)
constexpr bool PASSES_CACHES = true;

// Copy a line of memory.
INLINE void copy_past(const double *from, double *to) {
#if defined(__AVX512F__)
  _mm512_stream_pd(to, _mm512_loadu_pd(from));
#else
  for (int i = 0; i < 8; i += 2) _mm_stream_pd(to + i, _mm_loadu_pd(from + i));
#endif
}

// Other threads see all lines from here on.
INLINE void end_of_writes() { _mm_sfence(); }
#else
constexpr bool PASSES_CACHES = false;

INLINE void copy_past(const double *, double *) {}
INLINE void end_of_writes() {}
#endif

// Whole lines of memory that are still to be copied, of eight numbers each.
struct Late {
  static constexpr int64_t LINE = 8;

  const double *from;
  double *to;
  int64_t lines;

  // Copy what is before the first line and behind the last, and leave the lines.
  void begin(const double *numbers, int64_t count, double *out) {
    int64_t before = int64_t(-reinterpret_cast<uintptr_t>(out) / sizeof(double) % LINE);
    if (before > count) before = count;
    lines = (count - before) / LINE;
    for (int64_t i = 0; i < before; i++) out[i] = numbers[i];
    for (int64_t i = before + lines * LINE; i < count; i++) out[i] = numbers[i];
    from = numbers + before;
    to = out + before;
  }
};

}  // namespace sway
