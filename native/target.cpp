// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Chooses the instructions of this machine.
#include "frame.h"

namespace sway {

extern const Frame frame_baseline;
#if defined(__x86_64__)
extern const Frame frame_v3, frame_v4;
#endif

const Frame &frame_of_machine() {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw"))
    return frame_v4;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return frame_v3;
#endif
  return frame_baseline;
}

}  // namespace sway
