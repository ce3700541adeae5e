// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Memory that is taken while something is opened and returned when it is closed.
#pragma once

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define INLINE static inline __attribute__((always_inline, unused))

namespace sway {

// The code of a frame, which is compiled for several targets, takes no memory.
class Memory {
public:
  // Zeros for the same number of values for each of some arrays, which begin with a line of the cache.
  // Where memory is short, `is_short` is set and they are null.
  template <class... T> void take(uint64_t count, T *&...arrays) {
    ((arrays = static_cast<T *>(bytes_of(count, sizeof(T)))), ...);
  }

  void release() {
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

  void *bytes_of(uint64_t count, size_t each) {
    const size_t room = sizeof(Block) + LINE;
    Block *block = nullptr;
    if (!is_short && count <= (SIZE_MAX - room) / each)
      block = static_cast<Block *>(calloc(1, size_t(count) * each + room));
    is_short = !block;
    if (is_short) return nullptr;
    block->next = blocks;
    blocks = block;
    return reinterpret_cast<void *>((reinterpret_cast<uintptr_t>(block + 1) + LINE - 1) / LINE *
                                    LINE);
  }

  Block *blocks = nullptr;
};

}  // namespace sway
