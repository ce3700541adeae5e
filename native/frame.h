// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// What a stand is made of, and the work of a frame, which is compiled once for each target.
#pragma once

#include "library.h"
#include "model.h"
#include "past_caches.h"

namespace sway {

// Coefficients of a step under a constant force: a coordinate q of rate v and force f goes to
// c0 q + c1 v + c2 f, its rate to c3 q + c4 v + c5 f. Rows of `padded` numbers.
struct Step {
  double *whole;  // over the step
  double *half;   // over half of it, to where the load is found
  double dt;      // length of the step [s]
};

// Stiffness and damping of the coordinates of a model, as they are tuned (padded).
struct Tuning {
  double *stiffness, *damping;
  int64_t n_set;    // times that the step was set
  int64_t n_tuned;  // times that the stiffness has changed
};

// State of a tree: rows of `width` numbers (`sway_state`).
struct State {
  double *eta, *rate, *force, *hidden, *diagonal, *wanted;
  double *wind;  // (3), then:
  double *drag_density, *is_clamped, *left_out, *at_rest;
  double *crown;  // memory of its gusts (`crown_of`); null if they reach all limbs at once
};

// Coefficients of a part of the step of a limp tree (`coupled_step.h`); rows of `Limp::row` numbers
// are those of the `n_coupled` coordinates that are coupled.
struct CoupledStep {
  int64_t n_parts;  // of the step; 0 before it is filled
  Step part;
  int64_t n_coupled;
  int64_t *coupled;  // numbers of these
  double *stretch, *per_force, *own, *root_damping;
  double *own_damping;  // (padded)
};

// What a limp tree has beside its `State`: none of it is needed to go on from a state.
struct LimpTree {
  double *columns;               // J (m, places)
  double *change;                // inertia less 1 (q, row)
  double *weight;                // force of the weight beyond the linear (row)
  double *last_eta, *last_rate;  // as the last step left them (padded)
  double allowed;                // energy that the tree may have before the work of a step [J]
  int64_t next;                  // column that is renewed next
  bool has_begun;
  int64_t n_set, n_tuned;        // changes of its step and its stiffness that it has followed
  CoupledStep laws[4];           // by the number of parts, modulo 4
};

// Memory of one thread for limp trees.
struct LimpRoom {
  double *turned, *turning, *keys;            // key rotations, their rates, others (keys)
  double *here, *ahead, *behind;              // places
  double *tangent;                            // of the segments (places)
  double *force;                              // on them (places)
  double *gust;                               // (places)
  double *products;                           // of rows and columns (m + 2, row)
  const double **rows;                        // (m + 2)
  double *momentum, *across, *along;          // (row)
  double *matrix, *block, *coupled, *solved;  // (q, row), (q, row), (8, row), (3, row)
  double *eta, *rate, *new_force, *by_wind, *wanted, *sloped;  // (padded)
};

// Memory of one thread.
struct Room {
  // Placing.
  double *keys;   // key rotations (N), and some more that are read with them
  double *bases;  // orientation of the base of each branch and half its key rotation (b, 8)
  double *poses[2];  // of a tree (n, 7); the second where writes pass the caches
  double *slots;  // values of the sixteen branches of a block
  // A step; rows of coordinates.
  double *middle, *middle_rate, *change;
  float *turned, *damped, *single_rate, *distance, *shown;
  float *single_keys;  // (16)
  LimpRoom limp;
};

// A number of coordinates that a state has, 0 to `most`, whatever was written to it.
INLINE int64_t count_of(double value, int64_t most) {
  if (!(value > 0.0)) return 0;
  return value < double(most) ? int64_t(value) : most;
}

// Winds from here on are calm [m/s]: squares of all others, and of their sums, are finite.
constexpr double STRONGEST = 1e100;

// Where a tree stands.
struct Place {
  double cosine, sine;  // of half its turn about the vertical
  double scale;
  double at[3];
};

// The work of a frame.
struct Frame {
  // Step a tree in a wind in its own frame; whether it was clamped.
  bool (*step)(const sway_model &model, const double *stiffness, const Step &step, State &state,
               Room &room, const double wind[3]);
  // The same of a limp tree at its pose.
  bool (*step_at_pose)(const sway_model &model, const Tuning &tuning, const Step &step,
                       State &state, LimpTree &tree, Room &room, const double wind[3]);
  // Write the key rotations of a state to the room.
  void (*find_keys)(const sway_model &model, const State &state, Room &room);
  // Place a tree by the key rotations in the room, to (n, 7), and write meanwhile what is late.
  void (*place)(const sway_model &model, const Place &place, Room &room, double *poses, Late &late);
  // Write where the segments of a limp tree are at key rotations, a place of `Limp`, and the
  // directions of the segments unless null.
  void (*find_place)(const sway_model &model, Room &room, const double *keys, double *out,
                     double *tangent);
  // Write the changes of loads along shapes (`sway_load_slopes`).
  void (*load_slopes)(const sway_branches &tree, const double *x, const double *wind,
                      const double *shapes, size_t columns, double *scratch, double *turning,
                      double *damping);
  // Step the model `branch` (`sway_step_branches`).
  int64_t (*step_branches)(sway_branch_block *blocks, size_t count, double *rotations,
                           double *rates, const double wind[3], double drag_density);
  void (*rest_branches)(sway_branch_block *blocks, size_t count, const double wind[3],
                        double drag_density, const double *stiffness, double *rotations);
};

// Take the memory of one thread for trees of some models.
void open_room(Memory &memory, const sway_model *const *models, size_t n_models, Room &room);

// The work of a frame by the best instructions that this machine has.
const Frame &frame_of_machine();

// Numbers of `Room::slots` for branches of `rows` key rotations.
constexpr int64_t slots_of(int64_t rows) { return (2 * rows + 64) * WIDTH; }

// Numbers after the last of `Room::keys` that may be read.
constexpr int64_t KEYS_BEYOND = 64;

}  // namespace sway
