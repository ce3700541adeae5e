// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Memory that is taken while something is opened and returned when it is closed.
#pragma once

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

namespace sway {

class Memory {
public:
  // Zeros for a number of values, at the beginning of a cache line. Where memory is short,
  // `is_short` is set and nothing is returned.
  template <class T> __attribute__((always_inline)) T *take(uint64_t count) {
    const size_t room = sizeof(Block) + LINE;
    Block *block = nullptr;
    if (!is_short && count <= (SIZE_MAX - room) / sizeof(T))
      block = static_cast<Block *>(calloc(1, size_t(count) * sizeof(T) + room));
    is_short = !block;
    if (is_short) return nullptr;
    block->next = blocks;
    blocks = block;
    const uintptr_t first = reinterpret_cast<uintptr_t>(block + 1) + LINE - 1;
    return reinterpret_cast<T *>(first / LINE * LINE);
  }

  // The same number of values for each of some arrays.
  template <class... T>
  __attribute__((always_inline)) void take_each(uint64_t count, T *&...arrays) {
    ((arrays = take<T>(count)), ...);
  }

  __attribute__((always_inline)) void release() {
    while (blocks) {
      Block *next = blocks->next;
      free(blocks);
      blocks = next;
    }
  }

  bool is_short = false;

private:
  static constexpr size_t LINE = 64;
  struct Block {
    Block *next;
  };
  Block *blocks = nullptr;
};

}  // namespace sway
