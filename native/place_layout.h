// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Lays the branches of a model out in blocks of sixteen, and their segments in records.
#pragma once

#include "model.h"

namespace sway {

// Fill the blocks and segments of a model from its arrays, which were checked.
void lay_out_places(sway_model &model, const Arrays &arrays);

}  // namespace sway
