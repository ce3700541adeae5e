// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Gusts that reach the limbs of a tree one after another.
//
// The table has uniform winds only: it is read at the mean of the limbs' winds, weighted by their
// loads. Then the difference of load between the wind of each delay and the mean is added for the
// limbs of this delay. It is found on the tree at rest and reduced as the load on the bent tree is.
#pragma once

#include "gusts.h"
#include "table.h"
#include "turn.h"

namespace {

// Write the harmonics of a wind [m/s] times its dynamic pressure.
void fill_pressures(const sway_model &model, const Vector<double> &wind, double per_speed_squared,
                    double out[HARMONICS]) {
  const double speed = most(__builtin_sqrt(dot(wind, wind)), 1e-12);
  const double pressure = least(per_speed_squared * speed * speed, *model.table.most_pressure);
  fill_harmonics({wind.x / speed, wind.y / speed, wind.z / speed}, out);
  for (int number = 0; number < HARMONICS; number++) out[number] *= pressure;
}

// Add to a step in a mean wind what the winds of the limbs of each delay do beside it.
void add_gusts(const sway_model &model, const double *stiffness, const Step &step, State &state,
               Room &room, const Crown &crown, const Vector<double> &wind,
               const Vector<double> &mean, double per_speed_squared) {
  const int64_t M = model.padded;
  double in_mean[HARMONICS], own[HARMONICS];
  fill_pressures(model, mean, per_speed_squared, in_mean);
  double *force = room.change;
  for (int64_t i = 0; i < M; i++) force[i] = 0.0;
  for (int64_t delay = 0; delay < model.sizes.delays; delay++) {
    fill_pressures(model, wind + read(crown.apart + 3 * delay), per_speed_squared, own);
    const double *moments = model.table.limb_harmonics + delay * HARMONICS * M;
    for (int number = 0; number < HARMONICS; number++) {
      const double change = own[number] - in_mean[number];
      for (int64_t i = 0; i < M; i += LANES)
        store(force + i, load(force + i) + change * load(moments + number * M + i));
    }
  }
  // How much less than upright the tree that is bent is loaded, weighed by its deflection.
  Vec bent = {}, upright = {};
  for (int64_t i = 0; i < M; i += LANES) {
    Vec at_rest = {};
    for (int number = 0; number < HARMONICS; number++)
      at_rest += in_mean[number] * load(model.table.harmonics + number * M + i);
    const Vec deflection = at_rest / load(stiffness + i);
    bent += deflection * load(state.wanted + i);
    upright += deflection * at_rest;
  }
  const double share = least(most(sum(bent) / (sum(upright) + 1e-300), 0.0), 1.0);
  for (int64_t i = 0; i < M; i += LANES) {
    // As the force of the step.
    const Vec implicit = 1.0 - load(state.diagonal + i) * load(step.half + 5 * M + i);
    const Vec added = share * load(force + i) / implicit;
    store(state.eta + i, load(state.eta + i) + load(step.whole + 2 * M + i) * added);
    store(state.rate + i, load(state.rate + i) + load(step.whole + 5 * M + i) * added);
    store(state.force + i, load(state.force + i) + added);
  }
}

// Step a tree on its table in a wind [m/s] in its own frame, limb by limb where gusts reach them
// one after another. Returns whether wind or energy were clamped.
bool step_coordinates(const sway_model &model, const double *stiffness, const Step &step,
                      State &state, Room &room, const double velocity[3]) {
  const Vector<double> wind = read(velocity);
  const double per_speed_squared =
      drag_density(model.table.drag_law, __builtin_sqrt(dot(wind, wind)));
  if (!state.crown) return step_table(model, stiffness, step, state, room, wind, per_speed_squared);
  Crown &crown = crown_of(state.crown);
  push_crown(crown, *model.table.limb_spread, *model.table.crown_coherence, velocity, step.dt);
  Vector<double> apart = {};
  for (int64_t delay = 0; delay < model.sizes.delays; delay++)
    apart += model.table.limb_share[delay] * read(crown.apart + 3 * delay);
  const Vector<double> mean = wind + apart;
  const bool is_clamped = step_table(model, stiffness, step, state, room, mean, per_speed_squared);
  add_gusts(model, stiffness, step, state, room, crown, wind, mean, per_speed_squared);
  return is_clamped;
}

}  // namespace
