// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// The work of a frame for one target: SWAY_FRAME is the name of its functions.
#include "frame.h"

#include "limbs.h"
#include "place.h"
#ifndef SWAY_PAGE
#include "branch.h"
#include "limp.h"
#include "load_slopes.h"
#endif

namespace sway {

extern const Frame SWAY_FRAME;
#ifdef SWAY_PAGE
const Frame SWAY_FRAME = {step_coordinates, nullptr, find_keys, place,
                          nullptr,          nullptr, nullptr,   nullptr};
#else
const Frame SWAY_FRAME = {step_coordinates, step_at_pose, find_keys,     place,
                          find_place,       load_slopes,  step_branches, rest_branches};
#endif

}  // namespace sway
