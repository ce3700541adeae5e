// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
#include "branch_loads.h"

#include <string.h>

#include "frame.h"

extern "C" {

void sway_wind_moments(const sway_branches *tree, const double *x, const double *v,
                       const double *winds, size_t count, sway_branch_load *loads,
                       double *moments) {
  const int64_t n = keys_of(*tree);
  memset(moments, 0, n * count * sizeof(double));
  for (size_t pose = 0; pose < count; pose++, x += n, moments += n, winds += 3) {
    Load<double, double> *own = reinterpret_cast<Load<double, double> *>(loads);
    add_moments(*tree, x, v ? &v : nullptr, tree->damping_mode, read(winds), own, moments);
    for (int64_t b = 0; b < tree->branches; b++)
      own[b].force = rotated(own[b].orientation, turned_by(own[b].turn, own[b].own_force));
    if (v) v += n;
  }
}

void sway_load_slopes(const sway_branches *tree, const double *x, const double *wind,
                      const double *shapes, size_t columns, double *scratch, double *turning,
                      double *damping) {
  sway::frame_of_machine().load_slopes(*tree, x, wind, shapes, columns, scratch, turning, damping);
}

int64_t sway_step_branches(sway_branch_block *blocks, size_t count, double *rotations,
                           double *rates, double x, double y, double z, double drag_density) {
  const double wind[3] = {x, y, z};
  return sway::frame_of_machine().step_branches(blocks, count, rotations, rates, wind,
                                                drag_density);
}

void sway_rest_branches(sway_branch_block *blocks, size_t count, double x, double y, double z,
                        double drag_density, const double *stiffness, double *rotations) {
  const double wind[3] = {x, y, z};
  sway::frame_of_machine().rest_branches(blocks, count, wind, drag_density, stiffness, rotations);
}
}
