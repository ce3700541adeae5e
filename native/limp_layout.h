// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// A limp tree at rest: what its step at its pose needs, found by placing it.
#pragma once

#include "frame.h"

namespace sway {

// Whether a model has the arrays by which a tree is stepped at its pose.
bool has_pose(const Arrays &arrays);

// Fill `limp` of a model whose places and coordinates are laid out. Returns whether its segments
// have an inertia to solve with.
bool lay_out_limp(sway_model &model, const Arrays &arrays);

}  // namespace sway
