// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Writes past the caches: elsewhere a line of memory is read before it is written, which for poses of
// a thousand trees takes as long as to find them. They are made a few lines at a time while the next
// tree is placed, as memory takes them more slowly than they come.
#pragma once

#include <stdint.h>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace sway {

#if defined(__SSE2__)
constexpr bool PASSES_CACHES = true;
#else
constexpr bool PASSES_CACHES = false;
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

// Other threads see all lines from here on.
inline void end_of_writes() {
#if defined(__SSE2__)
  _mm_sfence();
#endif
}

}  // namespace sway
