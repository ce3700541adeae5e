// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Inertia, centrifugal force and weight of a limp tree at the pose it has, in its own coordinates.
//
// With p the points of the segments, m their masses and J = dp/dq, Lagrange's equations of the tree
// are (Shabana 2020, Dynamics of Multibody Systems, chapter 3)
//
//     M q'' + J' m (dJ/dt) q' = forces + J' m g,   M = J' m J.
//
// All three are found by placing the tree: a column of J is the difference of two places of the
// segments, and the centrifugal force the second difference along the motion. Columns are renewed in
// turn, an eighth of them a step or more: M is a product of a matrix with itself, and so is positive
// definite however old its columns are.
//
// No energy comes of it. In truth the change of M and the centrifugal force do no work together. So
// the rates are scaled to the kinetic energy that they had before a renewal, and what the
// centrifugal force has along the motion is left out.
#pragma once

#include "dense.h"
#include "place.h"

namespace {

// The largest rotation [rad] of a branch, and the largest number of steps, between two renewals of
// a column. In a storm, from a wind [m/s] on, columns as old as in a breeze throw a tree that was at
// rest too far: reeds to 0.1 m below the ground, and twigs by 1.4 times their true stride. In a
// breeze younger ones cost up to half of a step and gain nothing.
constexpr double OLDEST = 0.27, OLDEST_IN_STORM = 0.1, STORM = 15.0, MOST_STEPS = 8.0;

// Largest key rotation [rad] of the differences along the motion.
constexpr double MOTION_TURN = 1e-2;

// Write where the points of the segments are at key rotations; directions of the segments unless null.
void find_place(const sway_model &model, Room &room, const double *keys, double *out,
                double *tangent) {
  const Limp &limp = model.limp;
  const int64_t n = model.sizes.segments, each = limp.each;
  const Place at_origin = {1.0, 0.0, 1.0, {0.0, 0.0, 0.0}};
  memcpy(room.keys, keys, model.sizes.keys * sizeof(double));
  Late none = {};
  place(model, at_origin, room, *room.poses, none);
  for (int64_t i = 0; i < n; i++) {
    const double *pose = *room.poses + 7 * i;
    const Quaternion<double> q = {pose[6], pose[3], pose[4], pose[5]};
    const Vector<double> along = axis(q);
    const double directions[] = {along.x, along.y, along.z};
    for (int64_t point = i; point < POINTS * n; point += n) {
      const double factor = limp.root_mass[point], from_start = limp.from_start[point];
      for (int axis = 0; axis < 3; axis++) {
        out[axis * each + point] = factor * (pose[axis] + from_start * directions[axis]);
        if (tangent) tangent[axis * each + point] = directions[axis];
      }
    }
  }
  for (int axis = 0; axis < 3; axis++)
    for (int64_t i = axis * each + POINTS * n; i < (axis + 1) * each; i++) {
      out[i] = 0.0;
      if (tangent) tangent[i] = 0.0;
    }
}

// Write sums of shapes: key rotations of coordinates, and the rates of both.
void turn(const sway_model &model, const double *eta, const double *rate, double *turned,
          double *turning) {
  const Limp &limp = model.limp;
  const int64_t m = model.sizes.coordinates;
  constexpr int PARTS = 4;
  for (int64_t first = 0; first < limp.keys; first += PARTS * LANES) {
    const double *shapes = limp.shapes + first / 32 * m * 32 + first % 32;
    Vec of_eta[PARTS] = {}, of_rate[PARTS] = {};
    for (int64_t i = 0; i < m; i++)
      for (int part = 0; part < PARTS; part++) {
        const Vec shape = load(shapes + 32 * i + part * LANES);
        of_eta[part] += eta[i] * shape;
        of_rate[part] += rate[i] * shape;
      }
    for (int part = 0; part < PARTS; part++) {
      store(turned + first + part * LANES, of_eta[part]);
      store(turning + first + part * LANES, of_rate[part]);
    }
  }
}

// Take the inertia of the tree at rest.
void return_to_rest(const sway_model &model, LimpTree &tree) {
  const Limp &limp = model.limp;
  for (int64_t i = 0; i < model.sizes.coordinates * limp.places; i++)
    tree.columns[i] = limp.columns[i];
  memset(tree.change, 0, limp.leading * limp.row * sizeof(double));
  memset(tree.weight, 0, limp.row * sizeof(double));
  tree.next = 0;
}

// How many columns to renew after a branch has rotated by an angle [rad] in a wind of a speed.
INLINE int64_t columns_due(int64_t count, double turned, double speed) {
  const double share = turned / (speed < STORM ? OLDEST : OLDEST_IN_STORM);
  if (!(share > 1.0 / MOST_STEPS)) return (count + 7) / 8;
  return share < 1.0 ? int64_t(__builtin_ceil(share * count)) : count;
}

// Twice the kinetic energy [J] of rates; writes the momentum of leading coordinates.
double twice_kinetic_energy(const Limp &limp, const LimpTree &tree, int64_t padded,
                            const double *rate, double *momentum) {
  // Beyond the leading coordinates the matrix is zero.
  multiply(tree.change, limp.leading, limp.row, rate, limp.row < padded ? limp.row : padded,
           momentum);
  double energy = dot(rate, rate, padded);
  for (int64_t i = 0; i < limp.leading; i++) {
    energy += rate[i] * momentum[i];
    momentum[i] += rate[i];
  }
  return energy;
}

// Write where the segments are at an amount of a direction from here.
void place_along(const sway_model &model, Room &room, double amount, const double *direction,
                 double *out) {
  LimpRoom &own = room.limp;
  for (int64_t i = 0; i < model.limp.keys; i += LANES)
    store(own.keys + i, load(own.turned + i) + amount * load(direction + i));
  find_place(model, room, own.keys, out, nullptr);
}

// Turn the tree a little from here along each of the next coordinates, and take the difference as
// its column, and the weight on it, at coordinates `eta`. The rows of the room beyond the first two
// are these columns.
void find_columns(const sway_model &model, LimpTree &tree, Room &room, int64_t count,
                  const double *eta) {
  const Limp &limp = model.limp;
  const int64_t m = model.sizes.coordinates;
  LimpRoom &own = room.limp;
  for (int64_t k = 0; k < count; k++) {
    const int64_t number = (tree.next + k) % m;
    const double amount = limp.amount[number];
    place_along(model, room, amount, limp.directions + number * limp.keys, own.behind);
    double *column = tree.columns + number * limp.places;
    const double per_amount = 1.0 / amount;
    for (int64_t i = 0; i < limp.places; i += LANES)
      store(column + i, per_amount * (load(own.behind + i) - load(own.here + i)));
    own.rows[2 + k] = column;
    if (number >= limp.leading) continue;
    const double linear =
        limp.weight[number] + dot(limp.slopes + number * model.padded, eta, model.padded);
    tree.weight[number] = dot(column + 2 * limp.each, limp.gravity, limp.each) - linear;
  }
}

// Take the inertia of the new columns; the products of the first two rows with all columns are those
// of the pose too. Rates are scaled to the kinetic energy that they had before.
void renew(const sway_model &model, LimpTree &tree, Room &room, int64_t count, double *rate) {
  const Limp &limp = model.limp;
  const int64_t m = model.sizes.coordinates, M = model.padded, q = limp.leading;
  LimpRoom &own = room.limp;
  const double before = twice_kinetic_energy(limp, tree, M, rate, own.momentum);
  multiply_rows(own.rows, 2 + count, tree.columns, q, limp.places, limp.places, own.products,
                limp.row);
  for (int64_t k = 0; k < count; k++) {
    const int64_t row = (tree.next + k) % m;
    if (row >= q) continue;
    const double *inertia = own.products + (2 + k) * limp.row;
    for (int64_t j = 0; j < q; j++)
      tree.change[row * limp.row + j] = tree.change[j * limp.row + row] = inertia[j];
  }
  for (int64_t k = 0; k < count; k++) {
    const int64_t row = (tree.next + k) % m;
    if (row < q) tree.change[row * limp.row + row] -= 1.0;
  }
  tree.next = (tree.next + count) % m;
  const double after = twice_kinetic_energy(limp, tree, M, rate, own.momentum);
  if (!(after > 0.0)) return;
  const double scale = __builtin_sqrt(before / after);
  for (int64_t i = 0; i < M; i += LANES) store(rate + i, scale * load(rate + i));
}

// Find the centrifugal force from products of the bend of the motion but for what does work on the
// motion, and the momentum over twice the kinetic energy. `ahead` is the time [s] to the place
// ahead.
void find_centrifugal_force(const sway_model &model, const LimpTree &tree, LimpRoom &own,
                            const double *bend, const double *rate, double ahead) {
  const Limp &limp = model.limp;
  const double energy = twice_kinetic_energy(limp, tree, model.padded, rate, own.along);
  const bool moves = ahead > 0.0 && energy > 0.0;
  double working = 0.0;
  for (int64_t i = 0; i < limp.leading; i++) {
    own.across[i] = moves ? -bend[i] / (ahead * ahead) : 0.0;
    own.along[i] = moves ? own.along[i] / energy : 0.0;
    working += own.across[i] * rate[i];
  }
  for (int64_t i = 0; i < limp.leading; i++) own.across[i] -= working * own.along[i];
}

// Energy [J] of the weight beyond that which the stiffness has, at coordinates, at a place.
double weight_potential(const sway_model &model, LimpRoom &own, const double *eta,
                        const double *place) {
  const Limp &limp = model.limp;
  const int64_t M = model.padded;
  multiply(limp.all_slopes, model.sizes.coordinates, M, eta, M, own.sloped);
  const double linear = dot(limp.force, eta, M) + 0.5 * dot(eta, own.sloped, M);
  return linear - (dot(limp.gravity, place + 2 * limp.each, limp.each) - limp.potential);
}

}  // namespace
