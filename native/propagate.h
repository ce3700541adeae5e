// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Exact steps of oscillators I q'' + k2 q' + k1 q = M(t).
#pragma once

#include "frame.h"

namespace sway {

// Fill the coefficients of a step of dt [s] under a constant force, and of half of it, for oscillators
// of unit inertia, in rows of `stride` numbers. The half step goes to where the load of the wind is
// found: for coordinates that complete nearly a cycle per step it is an implicit Euler step, whose
// rate follows the force. That of the exact one may be opposite to it, and strong drag, which is
// implicit in the rate, would then feed the motion.
void fill_step(int64_t count, int64_t stride, const double *stiffness, const double *damping,
               double dt, const Step &step);

}  // namespace sway
