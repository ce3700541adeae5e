// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Exact steps of oscillators q'' + damping q' + stiffness q = f.
#pragma once

#include "frame.h"

namespace sway {

// Fill the coefficients of a step of dt [s] under a constant force, and of half of it, for the
// coordinates of a model. The half step goes to where the load of the wind is found: for
// coordinates that complete nearly a cycle per step it is an implicit Euler step, whose rate
// follows the force.
void fill_step(const sway_model &model, const double *stiffness, const double *damping, double dt,
               const Step &step);

}  // namespace sway
