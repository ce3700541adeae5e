// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// The work of a frame for one target: SWAY_TARGET is its name, SWAY_FRAME that of its functions.
#include "frame.h"

#include "branch.h"
#include "limbs.h"
#include "load_slopes.h"
#include "limp.h"
#include "place.h"

namespace sway {

extern const Frame SWAY_FRAME;
const Frame SWAY_FRAME = {SWAY_TARGET, step_coordinates, step_at_pose,  find_keys,    place,
                          find_place,  load_slopes,      step_branches, rest_branches};

}  // namespace sway
