// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// What a stand is made of, and the work of a frame, which is compiled once for each target.
#pragma once

#include "library.h"
#include "model.h"

namespace sway {

// Coefficients of a step under a constant force: a coordinate q of rate v and force f goes to
// c0 q + c1 v + c2 f, its rate to c3 q + c4 v + c5 f. Rows of `padded` numbers.
struct Step {
  double *whole;  // over the step
  double *half;   // over half of it, to where the load is found
  double dt;      // length of the step [s]
};

// State of a tree: rows of `width` numbers (`sway_state`).
struct State {
  double *eta, *rate, *force, *hidden, *diagonal, *wanted;
  double *wind;  // (3), then:
  double *drag_density, *is_clamped, *left_out, *at_rest;
  double *crown;  // memory of its gusts (`crown_of`); null if they reach all limbs at once
};

// Memory of one thread.
struct Room {
  // Placing.
  double *keys;   // key rotations (N), and some more that are read with them
  double *bases;  // orientation of the base of each branch and half its key rotation (b, 8)
  double *poses;  // one tree (n, 7)
  double *slots;  // values of the sixteen branches of a block
  // A step; rows of coordinates.
  double *middle, *middle_rate, *change;
  float *turned, *damped, *single_rate, *distance, *shown;
  float *single_keys;  // (16)
};

// A number of coordinates that a state has, 0 to `most`, whatever was written to it.
inline __attribute__((always_inline)) int64_t count_of(double value, int64_t most) {
  if (!(value > 0.0)) return 0;
  return value < static_cast<double>(most) ? static_cast<int64_t>(value) : most;
}

// Where a tree stands.
struct Place {
  double cosine, sine;  // of half its turn about the vertical
  double scale;
  double at[3];
};

// The work of a frame.
struct Frame {
  const char *target;
  // Step a tree in a wind in its own frame; whether it was clamped.
  bool (*step)(const sway_model &model, const double *stiffness, const Step &step, State &state,
               Room &room, const double wind[3]);
  // Write the key rotations of a state to the room.
  void (*find_keys)(const sway_model &model, const State &state, Room &room);
  // Place a tree by the key rotations in the room, to (n, 7).
  void (*place)(const sway_model &model, const Place &place, Room &room, double *poses);
  // Write the middles of the segments of poses, each times a factor, and their directions.
  void (*middles)(int64_t n, const double *poses, const double *factor, const double *half_length,
                  double *out, double *tangent);
  // Write the changes of loads along shapes (`sway_load_slopes`).
  void (*load_slopes)(const sway_branches &tree, const sway_branch_load *loads,
                      const double *shapes, size_t columns, double *scratch, double *turning,
                      double *damping);
  // Step the model `branch` (`sway_step_branches`).
  int64_t (*step_branches)(sway_branch_block *blocks, size_t count, double *rotations,
                           double *rates, const double wind[3], double drag_density);
  void (*rest_branches)(sway_branch_block *blocks, size_t count, const double wind[3],
                        double drag_density, const double *stiffness, double *rotations);
};

// The work of a frame by the best instructions that this machine has.
const Frame &frame_of_machine();

// Numbers of `Room::slots` for branches of `rows` key rotations.
constexpr int64_t slots_of(int64_t rows) { return (2 * rows + 64) * WIDTH; }

// Numbers after the last of `Room::keys` that may be read.
constexpr int64_t KEYS_BEYOND = 64;

}  // namespace sway
