// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// An error in the memory of a caller, cut off at its end.
#pragma once

#include <stddef.h>

namespace {

class Text {
public:
  Text(char *memory, size_t room) : next_(memory), left_(memory ? room : 0) {
    if (left_) *next_ = '\0';
  }

  Text &add(const char *words) {
    for (; *words && left_ > 1; left_--, words++) {
      *next_++ = *words >= ' ' && *words <= '~' ? *words : '?';
      *next_ = '\0';
    }
    return *this;
  }

private:
  char *next_;
  size_t left_;
};

}  // namespace
