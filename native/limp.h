// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// A step of a limp tree, one whose twigs turn so far that neither load nor inertia is that of a
// table ("A limp tree" of doc/sway_model.md):
//
//     M(q) q'' + C q' + K q = F(wind, q, q') - centrifugal force + weight beyond the linear.
#pragma once

#include "coupled_step.h"
#include "gusts.h"
#include "pose_inertia.h"
#include "table.h"

namespace {

// Longest part of a step [s]; in strong wind it is the last [m^2/s] over the square of the speed, but
// no shorter than the second. In longer ones whips rattle, for the drag of a step is found at the
// motion that the last step's force predicts.
constexpr double LONGEST_PART = 0.04, SHORTEST_PART = 1.0 / 480.0, PART_IN_STORM = 4.0;

constexpr double MOST_PARTS = 1000.0;

// Largest rate of the rotation of a branch [rad/s]: without it twigs outrun a storm of 80 m/s that
// comes at once. Turbulence up to 30 m/s does not reach it.
constexpr double FASTEST_TURN = 40.0;

// Share of the energy that the tree may gain of what it has lost: that of a motion without damping
// rises and falls by the error of a step.
constexpr double SLACK = 0.05;

// In how many parts a step of dt [s] is taken in a wind of a speed [m/s].
INLINE int64_t parts_of(double dt, double speed) {
  const double in_storm = PART_IN_STORM / most(speed * speed, 1.0);
  const double longest = least(LONGEST_PART, most(in_storm, SHORTEST_PART));
  return int64_t(__builtin_ceil(least(most(dt / longest - 1e-9, 1.0), MOST_PARTS)));
}

// Write the drag of a wind [m/s] on every segment at the pose, over the root of its mass, at 1 kg/m^3.
// The force on a segment of area A is A |u| u with u the velocity of the air across it. Its own
// velocity is the difference of the places ahead and behind; `per_time` [1/s] is one over the time
// between them.
void find_drag(const Limp &limp, LimpRoom &own, double per_time, const double wind[3]) {
  const int64_t each = limp.each;
  for (int64_t i = 0; i < each; i += LANES) {
    const Vec root = load(limp.root_mass + i), speed = load(limp.speed + i);
    Vec air[3], along = {}, square = {};
    for (int axis = 0; axis < 3; axis++) {
      const int64_t at = axis * each + i;
      const Vec moved = load(own.ahead + at) - load(own.behind + at);
      air[axis] = speed * (wind[axis] + load(own.gust + at)) - per_time / root * moved;
      along += air[axis] * load(own.tangent + at);
    }
    for (int axis = 0; axis < 3; axis++) {
      air[axis] -= along * load(own.tangent + axis * each + i);
      square += air[axis] * air[axis];
    }
    const Vec factor = load(limp.area + i) * ::root(square) / root;
    for (int axis = 0; axis < 3; axis++) store(own.force + axis * each + i, factor * air[axis]);
  }
}

// Write the gust that reaches each segment beside the wind of the tree.
void find_gusts(const sway_model &model, const State &state, const Step &step, const double wind[3],
                double *gust) {
  const Limp &limp = model.limp;
  memset(gust, 0, limp.places * sizeof(double));
  if (!state.crown || !limp.delay) return;
  Crown &crown = crown_of(state.crown);
  push_crown(crown, *model.table.limb_spread, *model.table.crown_coherence, wind, step.dt);
  for (int axis = 0; axis < 3; axis++)
    for (int64_t i = 0; i < POINTS * model.sizes.segments; i++)
      gust[axis * limp.each + i] = crown.apart[3 * limp.delay[i] + axis];
}

// Write the work that the forces on the segments do per unit of each coordinate, by their products
// with the columns of the leading ones.
void find_load(const sway_model &model, const LimpTree &tree, LimpRoom &own) {
  const Limp &limp = model.limp;
  const int64_t q = limp.leading, rest = model.sizes.coordinates - q;
  for (int64_t i = q - 1; i >= 0; i--) {
    double load = 0.0;
    for (int64_t j = 0; j <= i; j++) load += limp.factor[i * limp.row + j] * own.products[j];
    own.by_wind[i] = load;
  }
  multiply(tree.columns + q * limp.places, rest, limp.places, own.force, limp.places,
           own.by_wind + q);
  for (int64_t i = q + rest; i < model.padded; i++) own.by_wind[i] = 0.0;
}

// Go on to coordinates and rates of the room, where the tree is placed. The rates are scaled so that
// the tree gains no more energy than the work of the wind [J]; from then on it may have what it has,
// or has lost before, up to `SLACK`.
void end_part(const sway_model &model, const double *stiffness, State &state, LimpTree &tree,
              LimpRoom &own) {
  const int64_t M = model.padded;
  const double kinetic = 0.5 * twice_kinetic_energy(model.limp, tree, M, own.rate, own.momentum);
  double moving = kinetic, allowed = tree.allowed;
  for (int64_t i = 0; i < model.sizes.coordinates; i++) {
    moving += 0.5 * stiffness[i] * own.eta[i] * own.eta[i];
    allowed += own.by_wind[i] * (own.eta[i] - state.eta[i]);
  }
  double energy = moving + weight_potential(model, own, own.eta, own.here);
  double scale = 1.0;
  if (energy > allowed) {
    const double left = most(kinetic - (energy - allowed), 0.0);
    if (kinetic > 0.0) scale = __builtin_sqrt(left / kinetic);
    energy += left - kinetic;
  }
  for (int64_t i = 0; i < M; i++) {
    state.eta[i] = tree.last_eta[i] = own.eta[i];
    state.rate[i] = tree.last_rate[i] = scale * own.rate[i];
    state.force[i] = own.new_force[i];
  }
  tree.allowed = least(allowed, energy + SLACK * moving);
}

// Take a part of a step. Returns whether it would turn a branch too fast: then it goes a share of the
// way.
bool take_part(const sway_model &model, const double *stiffness, const CoupledStep &law,
               State &state, LimpTree &tree, Room &room, const double wind[3], double speed,
               double per_speed_squared) {
  const Limp &limp = model.limp;
  const int64_t M = model.padded, m = model.sizes.coordinates;
  LimpRoom &own = room.limp;
  // What has moved the tree beside its own steps, and how far.
  bool is_disturbed = false;
  for (int64_t i = 0; i < m; i++) {
    own.eta[i] = state.eta[i] - tree.last_eta[i];
    is_disturbed |= own.eta[i] != 0.0 || state.rate[i] != tree.last_rate[i];
  }
  double turned = 0.0;
  if (is_disturbed) {
    turn(model, own.eta, own.eta, own.turned, own.turning);
    turned = largest(own.turned, limp.keys);
    tree.allowed = __builtin_inf();
  }
  // The middle, with places ahead and behind along the motion.
  move_to_middle(model, law.part, state, room);
  memcpy(own.rate, state.rate, M * sizeof(double));
  turn(model, room.middle, room.middle_rate, own.turned, own.turning);
  const double fastest = largest(own.turning, limp.keys);
  const double ahead = fastest > 0.0 ? MOTION_TURN / fastest : 0.0;
  find_place(model, room, own.turned, own.here, own.tangent);
  place_along(model, room, ahead, own.turning, own.ahead);
  place_along(model, room, -ahead, own.turning, own.behind);
  find_drag(limp, own, ahead > 0.0 ? 0.5 / ahead : 0.0, wind);
  for (int64_t i = 0; i < limp.places; i += LANES)
    store(own.ahead + i, load(own.ahead + i) + load(own.behind + i) - 2.0 * load(own.here + i));
  own.rows[0] = own.force;
  own.rows[1] = own.ahead;
  const int64_t count = columns_due(m, turned + law.part.dt * fastest, speed);
  find_columns(model, tree, room, count, room.middle);
  renew(model, tree, room, count, own.rate);
  // The force.
  find_load(model, tree, own);
  for (int64_t i = 0; i < M; i++) {
    own.by_wind[i] *= per_speed_squared;
    own.wanted[i] = own.by_wind[i];
  }
  for (int64_t i = 0; i < limp.leading; i++) own.wanted[i] += tree.weight[i];
  find_centrifugal_force(model, tree, own, own.products + limp.row, room.middle_rate, ahead);
  find_coupled_force(model, law, state, tree, own, per_speed_squared * speed);
  // The whole part.
  move(law.part.whole, M, state.eta, own.rate, own.new_force, own.eta, own.rate);
  turn(model, own.eta, own.rate, own.turned, own.turning);
  const double fastest_now = largest(own.turning, limp.keys);
  const bool is_bounded = fastest_now > FASTEST_TURN;
  if (is_bounded) {
    const double share = FASTEST_TURN / fastest_now;
    for (int64_t i = 0; i < M; i++) {
      own.eta[i] = state.eta[i] + share * (own.eta[i] - state.eta[i]);
      own.rate[i] *= share;
    }
    turn(model, own.eta, own.rate, own.turned, own.turning);
  }
  find_place(model, room, own.turned, own.here, nullptr);
  end_part(model, stiffness, state, tree, own);
  return is_bounded;
}

// Whether a tree is at rest.
INLINE bool is_at_rest(const State &state, int64_t count) {
  bool moves = false;
  for (int64_t i = 0; i < count; i++)
    moves |= state.eta[i] != 0.0 || state.rate[i] != 0.0 || state.force[i] != 0.0;
  return !moves;
}

// Follow what was set or written between steps.
void follow(const sway_model &model, const Tuning &tuning, const State &state, LimpTree &tree) {
  if (tree.n_set != tuning.n_set)
    for (CoupledStep &law : tree.laws) law.n_parts = 0;
  if (tree.n_tuned != tuning.n_tuned) tree.allowed = __builtin_inf();
  tree.n_set = tuning.n_set;
  tree.n_tuned = tuning.n_tuned;
  if (tree.has_begun && !is_at_rest(state, model.padded)) return;
  // As at first, whatever it did before.
  tree.has_begun = true;
  return_to_rest(model, tree);
  memset(tree.last_eta, 0, model.padded * sizeof(double));
  memset(tree.last_rate, 0, model.padded * sizeof(double));
  tree.allowed = __builtin_inf();
}

// Step a limp tree at its pose in a wind [m/s] in its own frame. A long step is taken in parts.
// Returns whether any of them was bounded.
bool step_at_pose(const sway_model &model, const Tuning &tuning, const Step &step, State &state,
                  LimpTree &tree, Room &room, const double wind[3]) {
  follow(model, tuning, state, tree);
  find_gusts(model, state, step, wind, room.limp.gust);
  const double speed = __builtin_sqrt(wind[0] * wind[0] + wind[1] * wind[1] + wind[2] * wind[2]);
  const double per_speed_squared = drag_density(model.table.drag_law, speed);
  const int64_t n_parts = parts_of(step.dt, speed);
  CoupledStep &law = tree.laws[n_parts % 4];
  if (law.n_parts != n_parts) fill_coupled(model, tuning, step.dt, n_parts, law);
  bool is_bounded = false;
  for (int64_t part = 0; part < n_parts; part++)
    is_bounded |=
        take_part(model, tuning.stiffness, law, state, tree, room, wind, speed, per_speed_squared);
  for (int axis = 0; axis < 3; axis++) state.wind[axis] = wind[axis];
  *state.drag_density = per_speed_squared;
  *state.is_clamped = is_bounded;
  for (int64_t i = 0; i < model.padded; i++) {
    state.diagonal[i] = 0.0;
    state.wanted[i] = room.limp.by_wind[i];
  }
  return is_bounded;
}

}  // namespace
