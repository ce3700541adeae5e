// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// The model `branch`, the method of Kanda & Ohya: one equation of motion for each branch.
//
// In each branch the paper solves the motion of the segment that plays the central part in its
// deformation, and places the others geometrically. With q the position and rotation of this
// segment, M its mass, P the force of the wind, K the resistance to bending and R the friction,
//
//     M v' = F - G^T lambda,   v = q',   phi(q) = 0,   G = d phi / d q        (1)
//     F = P - K - R,   K = k1 theta,   R = k2 theta'                          (2)
//
// The constraint phi holds the root-side node of the segment in its place. Here q is the rotation
// about this node, so that phi holds by itself and lambda is eliminated. A branch has two such key
// rotations theta = (x, y), about two fixed axes across its chord:
//
//     J theta'' = T - k1 theta - k2 theta'
//
// with T the moment of P on the branch, in its bent direction, and J its inertia about the base,
// with the branches that it carries. As in the paper each branch moves as if its base were at
// rest: neither the motion of its parent nor the wind on the branches that it carries has an
// effect on it.
//
// A step. Between two loads the equation is linear, and is solved exactly: rows of the propagator.
// The load is found once per step, at the state at the middle of the step (exponential midpoint
// rule), and is constant over the step. Its dependence on the angle of the branch is corrected
// once within the step.
//
// A branch on two axes. Theta is the rotation vector in the rest frame of the branch (b along its
// chord, e1 and e2 across): the chord points along u = cos|theta| b + sinc|theta| (x e1 + y e2). In
// steady wind it moves in one plane, the paper's; in other winds it has no singular direction. With
// t = x^2 + y^2, J the inertia and W the force times its lever, Lagrange's equations on the sphere
// are
//
//     J (theta'' - gyroscopic) + k2 theta' + k1 theta = true_force
//     true_force = W_perp / sinc + theta (theta . W)(cos - 1 / sinc) / t - W_b sinc theta
//     gyroscopic = E L^2 theta + 2 B L (-vy, vx),   L = x vy - y vx
//
// The second line of the kinetic energy, T = J/2 (|v|^2 + (sinc^2 - 1) L^2 / t), is analytic in
// (x, y), and so are its derivatives, which in this form have no division by t. With sinc = 1 + t s
// and cos = 1 + t c: A = s + c + t s c, B = (s - c) / sinc, E = (A + 2 B) / t.
//
// Guard. For these terms (x, y) is clamped to sinc >= 0.3 (2.36 rad): beyond it they have their
// values on the circle. The load is clamped to |W| <= s_max k1, the whole moment at 1.5 s_max k1,
// and the gyroscopic term is left out where a step does not resolve the motion. A bounded moment on
// an exact, stable propagator gives a bounded motion, for any wind and step.
#pragma once

#include "library.h"
#include "turn.h"

namespace {

constexpr double T_MAX = 5.5528;  // square of the angle [rad^2] at which sinc = 0.3

// The two key rotations of branches or what belongs to them.
struct Pair {
  Vec x, y;
};

INLINE Pair operator+(const Pair &a, const Pair &b) { return {a.x + b.x, a.y + b.y}; }
INLINE Pair operator*(Vec scale, const Pair &a) { return {scale * a.x, scale * a.y}; }
INLINE Vec dot(const Pair &a, const Pair &b) { return a.x * b.x + a.y * b.y; }

INLINE Pair within_guard(const Pair &theta) {
  const Vec t = dot(theta, theta);
  const Vec shrink = t > T_MAX ? root(T_MAX / t) : all(1.0);
  return shrink * theta;
}

// s and c are series in t, with errors up to 3e-11 within the guard; s = -1/6 + t s1 and
// c = -1/2 + t c1.
struct Series {
  explicit inline __attribute__((always_inline)) Series(Vec t)
      : s1(all(BY.sinc[8])), c1(all(BY.cosine[8])) {
    for (int term = 7; term > 1; term--) {
      s1 = s1 * t + BY.sinc[term];
      c1 = c1 * t + BY.cosine[term];
    }
    s = s1 * t + BY.sinc[1];
    c = c1 * t + BY.cosine[1];
  }

  Vec s1, c1, s, c;
};

// The moment T of a force times its lever, W along b, e1, e2 [N m], at any deflection; it is (W_1,
// W_2) at none.
INLINE Pair true_force(const Pair &deflection, const Vector<Vec> &w) {
  const Pair theta = within_guard(deflection);
  const Vec t = dot(theta, theta);
  const Series by(t);
  const Vec sinc = 1.0 + t * by.s, inverse = 1.0 / sinc;
  const Pair across = {w.y, w.z};
  const Vec along = dot(theta, across) * (by.s + by.c + t * by.s * by.c) * inverse - w.x * sinc;
  return inverse * across + along * theta;
}

// The acceleration [rad/s^2] of motion along great circles of the sphere at constant speed; zero
// for motion in one plane.
INLINE Pair gyroscopic(const Pair &deflection, const Pair &rate) {
  const Pair theta = within_guard(deflection);
  const Vec t = dot(theta, theta);
  const Series by(t);
  const Vec inverse = 1.0 / (1.0 + t * by.s);
  const Vec b = (by.s - by.c) * inverse;
  const Vec e =
      (3.0 * by.s1 - by.c1 + by.s * by.c + by.s * (by.s + by.c + t * by.s * by.c)) * inverse;
  const Vec spin = theta.x * rate.y - theta.y * rate.x;
  const Vec turn = 2.0 * b * spin;
  return e * spin * spin * theta + turn * Pair{-rate.y, rate.x};
}

// True force and gyroscopic term together [N m], clamped to a limit.
INLINE Pair moment_of(const Pair &theta, const Pair &rate, const Vector<Vec> &w, Vec gyro_inertia,
                      Vec limit) {
  const Pair moment = true_force(theta, w) + gyro_inertia * gyroscopic(theta, rate);
  const Vec square = dot(moment, moment);
  return (square > limit * limit ? limit / root(square) : all(1.0)) * moment;
}

// Clamp the length of loads to a limit [N m]; one that is not a number, or whose square overflows,
// becomes zero. Returns in how many lanes.
INLINE int64_t limit_load(Vector<Vec> &w, Vec limit) {
  const Vec square = dot(w, w);
  const Mask is_within = square <= limit * limit, is_finite = square < all(__builtin_inf());
  const Vec scale = is_within ? all(1.0) : limit / root(square);
  const Mask is_kept = is_within | is_finite;
  w = {is_kept ? scale * w.x : Vec{}, is_kept ? scale * w.y : Vec{}, is_kept ? scale * w.z : Vec{}};
  int64_t n_within = 0;
  for (int lane = 0; lane < LANES; lane++) n_within -= is_within[lane];
  return LANES - n_within;
}

// The force P of the wind, found at the middle of the step: |U_n| U_n times drag density and area,
// U_n the velocity of the air across the branch, relative to it. It is implicit in the branch's own
// motion: with u the velocity at the middle of the step without the force and beta that per unit of
// force, the relative speed s solves s + beta c s^2 = |U - u|.
INLINE void find_wind_force(sway_branch_block &block, int slot, const Pair &theta, const Pair &rate,
                            const double wind[3], double drag_density) {
  const Vector<Vec> gust = load_vector(block.gust, slot);
  const Vector<Vec> air =
      load(block.speed + slot) * Vector<Vec>{wind[0] + gust.x, wind[1] + gust.y, wind[2] + gust.z};
  const Vector<Vec> rotation = theta.x * load_vector(block.load_rotation[0], slot) +
                               theta.y * load_vector(block.load_rotation[1], slot);
  const Vector<Vec> own = rate.x * load_vector(block.damping_mode[0], slot) +
                          rate.y * load_vector(block.damping_mode[1], slot);
  const Vec compliance = load(block.compliance + slot);
  const Vector<Vec> u =
      turned_by(-1.0 * rotation, air) - own + compliance * load_vector(block.drag_impulse, slot);
  Vec projector[6];
  for (int k = 0; k < 6; k++) projector[k] = load(block.projector[k] + slot);
  const Vector<Vec> across = times_symmetric(projector, u);
  const Vec spread = load(block.spread + slot) * dot(rate, rate);
  const Vec speed = root(most(dot(u, across), Vec{}) + spread);
  const Vec drag = drag_density * load(block.area + slot) * speed;
  const Vec share = 2.0 / (1.0 + root(1.0 + 4.0 * compliance * drag));
  const Vec per_velocity = drag * share * share;
  store_vector(block.drag_impulse, slot, per_velocity * u);
  store_vector(block.force, slot, turned_by(rotation, per_velocity * across));
}

// P times its lever: along the chord, and on the key rotations.
INLINE Vector<Vec> load_of(const sway_branch_block &block, int slot) {
  const Vector<Vec> force = load_vector(block.force, slot);
  return {dot(load_vector(block.chord_lever, slot), force),
          dot(load_vector(block.load_mode[0], slot), force),
          dot(load_vector(block.load_mode[1], slot), force)};
}

// Step the lanes of a block from a slot on: `state` has the key rotations (2, 16) and their rates.
// Returns how many loads were clamped.
INLINE int64_t step_lanes(sway_branch_block &block, int slot, Row *state, const double wind[3],
                          double drag_density) {
  const Pair theta = {load(state[0] + slot), load(state[1] + slot)};
  const Pair rate = {load(state[2] + slot), load(state[3] + slot)};
  Vec half[6], c[8];
  for (int k = 0; k < 6; k++) half[k] = load(block.half[k] + slot);
  for (int k = 0; k < 8; k++) c[k] = load(block.whole[k] + slot);

  // The middle of the step, under the last load.
  const Pair last = true_force(theta, load_vector(block.load, slot));
  const Pair middle = within_guard(half[0] * theta + half[1] * rate + half[2] * last);
  const Pair middle_rate = half[3] * theta + half[4] * rate + half[5] * last;
  find_wind_force(block, slot, middle, middle_rate, wind, drag_density);
  Vector<Vec> w = load_of(block, slot);
  store_vector(block.load, slot, w);

  // The step under the load: predictor and corrector of the moment.
  const Vec gyro_inertia = load(block.guard[0] + slot), limit = load(block.guard[2] + slot);
  const int64_t n_clamped = limit_load(w, load(block.guard[1] + slot));
  const Pair before = moment_of(theta, rate, w, gyro_inertia, limit);
  const Pair ahead = c[0] * theta + c[1] * rate + c[2] * before;
  const Pair ahead_rate = c[4] * theta + c[5] * rate + c[6] * before;
  const Pair after =
      moment_of(ahead + c[3] * before, ahead_rate + c[7] * before, w, gyro_inertia, limit);
  const Pair to = ahead + c[3] * after, to_rate = ahead_rate + c[7] * after;
  store(state[0] + slot, to.x);
  store(state[1] + slot, to.y);
  store(state[2] + slot, to_rate.x);
  store(state[3] + slot, to_rate.y);
  return n_clamped;
}

// How often, and how far each time, a branch goes towards the pose that its springs have under the
// load of the last.
constexpr int REST_TURNS = 30;
constexpr double REST_SHARE = 0.4;

void rest_branches(sway_branch_block *blocks, size_t count, const double wind[3],
                   double drag_density, const double *stiffness, double *rotations) {
  for (size_t first = 0; first < count; first += 16) {
    const size_t n = count - first < 16 ? count - first : 16;
    Row k1, state[2];
    for (size_t slot = 0; slot < 16; slot++) k1[slot] = slot < n ? stiffness[first + slot] : 1.0;
    for (int slot = 0; slot < 16; slot += LANES) {
      Pair theta = {};
      for (int turn = 0; turn < REST_TURNS; turn++) {
        find_wind_force(blocks[first / 16], slot, theta, Pair{}, wind, drag_density);
        const Pair moment = true_force(theta, load_of(blocks[first / 16], slot));
        const Pair away = 1.0 / load(k1 + slot) * moment + all(-1.0) * theta;
        theta = within_guard(theta + all(REST_SHARE) * away);
      }
      store(state[0] + slot, theta.x);
      store(state[1] + slot, theta.y);
    }
    for (size_t slot = 0; slot < n; slot++)
      for (size_t axis = 0; axis < 2; axis++)
        rotations[2 * (first + slot) + axis] = state[axis][slot];
  }
}

int64_t step_branches(sway_branch_block *blocks, size_t count, double *x, double *v,
                      const double wind[3], double drag_density) {
  int64_t n_clamped = 0;
  double not_finite = 0.0;  // a difference of equal numbers is 0 unless they are not finite
  for (size_t first = 0; first < count; first += 16) {
    const size_t n = count - first < 16 ? count - first : 16;
    Row state[4] = {};
    for (size_t slot = 0; slot < n; slot++)
      for (size_t axis = 0; axis < 2; axis++) {
        state[axis][slot] = x[2 * (first + slot) + axis];
        state[2 + axis][slot] = v[2 * (first + slot) + axis];
      }
    for (int slot = 0; slot < 16; slot += LANES)
      n_clamped += step_lanes(blocks[first / 16], slot, state, wind, drag_density);
    for (size_t slot = 0; slot < n; slot++)
      for (size_t axis = 0; axis < 2; axis++) {
        x[2 * (first + slot) + axis] = state[axis][slot];
        v[2 * (first + slot) + axis] = state[2 + axis][slot];
        not_finite += state[axis][slot] - state[axis][slot];
        not_finite += state[2 + axis][slot] - state[2 + axis][slot];
      }
  }
  return not_finite == 0.0 ? n_clamped : -1;
}

}  // namespace
