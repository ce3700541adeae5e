// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// A step of oscillators that an inertia beyond their own couples.
//
// Each coordinate has the mass 1 and moves exactly, as an oscillator of its own, under a force f that
// is constant over the step of length h (`propagate.h`). What the inertia M has beyond 1 is a part of
// that force, by the mean acceleration over the step:
//
//     f = F - (M - 1) (v1 - v0) / (h T),   v1 = v1(q0, v0, f),   T = tan(w h / 2) / (w h / 2),
//
// which is linear in f. As q1 - q0 = h T (v0 + v1) / 2 for a coordinate of the circular frequency w,
// this f does exactly the work that v' (M - 1) v / 2 loses: with a constant M, no step of any length
// makes energy. With the acceleration u that f makes, as unknown, the matrix is symmetric and
// positive definite:
//
//     (k + M - 1 + D) u = T F - (M - 1) a + D u0,   k = T f / u >= 1,   D = h B / 2
//
// with a the mean acceleration without f, and u0 that of the last step: the drag is implicit by the
// damping B of the air, for F was found at the rates which the last step's force predicts. B is
// S M S, S the roots of the damping of each coordinate at rest: a motion that hardly moves the bent
// tree is hardly damped there. With more damping than that its force would follow late, and feed it.
//
// A force s that is at right angles to the motion v in the middle, as the centrifugal, would lengthen
// v if it were constant. It turns with the motion instead, as G (v0 + v1) / 2 with the antisymmetric
// G = s r' - r s', r = M v / (v' M v), so that G v = s, and does no work.
#pragma once

#include "dense.h"
#include "propagate.h"

namespace {

// Largest angle [rad] by which a coordinate swings in a step with more inertia than its own: T is
// infinite at half a turn.
constexpr double FASTEST_SWING = 2.5;

// Fill the coefficients of a part of a step of dt [s].
void fill_coupled(const sway_model &model, const Tuning &tuning, double dt, int64_t n_parts,
                  CoupledStep &law) {
  const Limp &limp = model.limp;
  const int64_t M = model.padded;
  const double h = dt / double(n_parts);
  fill_step(model.sizes.coordinates, M, tuning.stiffness, tuning.damping, h, law.part);
  law.part.dt = h;
  law.n_parts = n_parts;
  int64_t n_coupled = 0;  // its own, so that two threads at once write no row past the last
  const double *by_force = law.part.whole + 5 * M;
  for (int64_t i = 0; i < model.sizes.coordinates; i++) {
    law.own_damping[i] = 0.5 * limp.damping[i] * by_force[i];
    const double angle = __builtin_sqrt(tuning.stiffness[i]) * h;
    if (i >= limp.leading || !(angle < FASTEST_SWING)) continue;
    const int64_t k = n_coupled++;
    const double half = most(0.5 * angle, 1e-12);
    law.coupled[k] = i;
    law.stretch[k] = __builtin_tan(half) / half;
    law.per_force[k] = by_force[i] / h;
    law.own[k] = law.stretch[k] / law.per_force[k];
    law.root_damping[k] = __builtin_sqrt(0.5 * h * limp.damping[i]);
  }
  law.n_coupled = n_coupled;
}

// Rows of `LimpRoom::coupled`.
enum { FREE, LAST_PULL, TURNING, ALONG, ROOTED, INERTIAL, DRAGGED, INVERSE };

// Find the constant force of the step, `new_force`, by the force F at the middle, `wanted`, the force
// s at right angles to the motion, `across`, and r, `along`; `drag` is that of the air on the
// coordinates, a factor of their damping.
void find_coupled_force(const sway_model &model, const CoupledStep &law, const State &state,
                        const LimpTree &tree, LimpRoom &own, double drag) {
  const int64_t M = model.padded, stride = model.limp.row, count = law.n_coupled;
  for (int64_t i = 0; i < M; i += LANES) {
    const Vec damped = drag * load(law.own_damping + i);
    store(own.new_force + i,
          (load(own.wanted + i) + damped * load(state.force + i)) / (1.0 + damped));
  }
  double *row[8];
  for (int k = 0; k < 8; k++) row[k] = own.coupled + k * stride;
  const double half = 0.5 * law.part.dt;
  const double *whole = law.part.whole;
  double turning_rate = 0.0, along_rate = 0.0;
  for (int64_t k = 0; k < stride; k++) row[FREE][k] = row[ROOTED][k] = 0.0;
  for (int64_t k = 0; k < count; k++) {
    const int64_t i = law.coupled[k];
    const double rate = own.rate[i];
    const double free =
        (whole[3 * M + i] * state.eta[i] + (whole[4 * M + i] - 1.0) * rate) / law.part.dt;
    row[FREE][k] = free;
    row[LAST_PULL][k] = law.per_force[k] * state.force[i];
    row[ROOTED][k] = law.root_damping[k] * row[LAST_PULL][k];
    row[TURNING][k] = own.across[i];
    row[ALONG][k] = own.along[i];
    const double steered = rate + half * free;
    turning_rate += own.across[i] * steered;
    along_rate += own.along[i] * steered;
  }
  const double *change = tree.change;
  if (count < model.limp.leading) {
    for (int64_t k = 0; k < count; k++)
      for (int64_t j = 0; j < stride; j++)
        own.block[k * stride + j] =
            j < count ? tree.change[law.coupled[k] * stride + law.coupled[j]] : 0.0;
    change = own.block;
  }
  const double *sides[] = {row[FREE], row[ROOTED]};
  multiply_rows(sides, 2, change, count, stride, stride, row[INERTIAL], stride);
  for (int64_t k = 0; k < count; k++) {
    const double root = law.root_damping[k];
    double *out = own.matrix + k * stride;
    const double *in = change + k * stride;
    for (int64_t j = k / LANES * LANES; j < stride; j += LANES)
      store(out + j, load(in + j) * (1.0 + drag * root * load(law.root_damping + j)));
    out[k] += law.own[k] + drag * root * root;
    out[count] = law.stretch[k] * own.wanted[law.coupled[k]] + row[TURNING][k] * along_rate -
                 row[ALONG][k] * turning_rate + drag * root * (row[DRAGGED][k] + row[ROOTED][k]) -
                 row[INERTIAL][k];
    out[count + 1] = row[TURNING][k];
    out[count + 2] = row[ALONG][k];
  }
  memset(own.solved, 0, 3 * stride * sizeof(double));
  if (!solve_positive(own.matrix, count, stride, 3, row[INVERSE], own.solved)) return;
  // Add h G / 2, of rank two, by Woodbury's formula: the matrix of two that is left, and its sides.
  double *solved = own.solved;
  const double *by_turning = solved + stride, *by_along = solved + 2 * stride;
  double products[2][3] = {};  // of along and turning with the three solutions
  for (int64_t k = 0; k < count; k++)
    for (int side = 0; side < 3; side++) {
      products[0][side] += row[ALONG][k] * solved[side * stride + k];
      products[1][side] += row[TURNING][k] * solved[side * stride + k];
    }
  const double one_one = 1.0 - half * products[0][1], one_two = half * products[0][2];
  const double two_one = -half * products[1][1], two_two = 1.0 + half * products[1][2];
  const double one = products[0][0], two = products[1][0];
  const double determinant = one_one * two_two - one_two * two_one;
  const double share_along = (two_two * one - one_two * two) / determinant;
  const double share_turning = (one_one * two - two_one * one) / determinant;
  for (int64_t k = 0; k < count; k++) {
    const double turned = by_turning[k] * share_along - by_along[k] * share_turning;
    own.new_force[law.coupled[k]] = (solved[k] + half * turned) / law.per_force[k];
  }
}

}  // namespace
