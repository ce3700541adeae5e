// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Outward pass of motion and inward pass of loads through the branches of a tree.
//
// Outward, from the stem to the twigs: the motion of each base follows from that of its parent, in
// its own turned frame, and the wind's force on each branch from its relative velocity. Inward,
// from the twigs to the stem: forces and moments are summed over subtrees.
//
// The passes are each other's transpose. The drag does work at the very velocities that it is
// computed from, however far the tree is bent.
//
// X, of the pose, and V, of motion and loads, are double, or a number with its changes. Amounts of key
// rotations, or of their rates, are numbered; without rates the tree is still.
#pragma once

#include "library.h"
#include "turn.h"

namespace {

// `sway_branch_load`, of such numbers.
template <class X, class V> struct Load {
  Vector<V> velocity, spin;
  Quaternion<X> orientation;
  Vector<X> rotation, displacement, arm, turn;
  Vector<V> flow, own_force, force, wrench_force, wrench_moment;
};

static_assert(sizeof(Load<double, double>) == sizeof(sway_branch_load), "sway_branch_load");

INLINE double root(double value) { return __builtin_sqrt(most(value, 0.0)); }

INLINE void add(double *out, int64_t key, double moment) { out[key] += moment; }

// Sum a mode (b, k, 3) of a branch by the amounts of its key rotations.
template <class V, class A>
INLINE Vector<V> moved(const sway_branches &tree, int64_t b, const A &amounts, const double *mode) {
  Vector<V> sum = {};
  const double *row = mode + 3 * tree.keys * b;
  for (int64_t c = 0; c < tree.n_coordinates[b]; c++)
    sum += amounts[tree.coordinate[b] + c] * read(row + 3 * c);
  return sum;
}

// Displacement and rotation vector of a base, or their rates, by its parent's key rotations.
template <class V> struct Joint {
  Vector<V> shift, rotation;
};

template <class V, class A>
INLINE Joint<V> joint_of(const sway_branches &tree, int64_t b, const A &amounts) {
  Joint<V> joint = {};
  const int64_t parent = tree.parent[b];
  const double *twist = tree.twist + 6 * tree.keys * b;
  for (int64_t c = 0; c < tree.n_coordinates[parent]; c++, twist += 6) {
    const V amount = amounts[tree.coordinate[parent] + c];
    joint.shift += amount * read(twist);
    joint.rotation += amount * read(twist + 3);
  }
  joint.shift += cross(joint.rotation, read(tree.base + 3 * b));
  return joint;
}

// The motion of a base. It keeps its distance from the parent's base, as the end of a rod: where it is
// displaced by s across an arm a, it comes closer by |s|^2 / (2 |a|).
template <class X, class V, class A, class B>
INLINE void go_outward(const sway_branches &tree, int64_t b, const A &x, const B *v,
                       const Load<X, V> &on, Load<X, V> &own) {
  const Vector<double> rest_arm = read(tree.arm + 3 * b);
  const double per_arm = tree.per_arm[b];
  const Joint<X> joint = joint_of<X>(tree, b, x);
  own.displacement = joint.shift;
  own.rotation = joint.rotation;
  own.arm = joint.shift + (1.0 - per_arm * dot(joint.shift, joint.shift)) * rest_arm;
  own.orientation = product(on.orientation, quaternion_of(joint.rotation));
  own.velocity = own.spin = Vector<V>{};
  if (!v) return;
  // In the frame of the parent's base, then in that of the base itself.
  const Joint<V> rate = joint_of<V>(tree, b, *v);
  const V shortening = 2.0 * per_arm * dot(joint.shift, rate.shift);
  const Vector<X> back = -1.0 * joint.rotation;
  own.velocity =
      turned_by(back, on.velocity + cross(on.spin, own.arm) + rate.shift - shortening * rest_arm);
  own.spin = turned_by(back, on.spin + spin_by(joint.rotation, rate.rotation));
}

// The force |U_n| U_n times the area of a branch, where U is the velocity of the air relative to it,
// and U_n the part across its pieces, whose own motion has a variance.
template <class V>
INLINE Vector<V> drag_of(const sway_branches &tree, int64_t b, const Vector<V> &flow,
                         const V &variance) {
  const Vector<V> across = times_symmetric(tree.projector + 6 * b, flow);
  return tree.area[b] * root(dot(flow, across) + variance) * across;
}

// The force of the wind on a branch: the velocity of the air less that of the base, of the branch
// itself by a mode, and of its spin.
template <class X, class V, class A, class B>
INLINE void find_force(const sway_branches &tree, int64_t b, const A &x, const B *v,
                       const double *mode, const Vector<X> &wind, Load<X, V> &own) {
  const Quaternion<X> &q = own.orientation;
  const Vector<X> air = tree.speed[b] * rotated({q.w, -q.x, -q.y, -q.z}, wind);
  own.turn = moved<X>(tree, b, x, tree.load_rotation);
  const Vector<X> back = -1.0 * own.turn;
  own.flow = turned_by(back, air - own.velocity);
  V variance = {};
  if (v) {
    const Matrix coupling = read_matrix(tree.coupling + 9 * b);
    own.flow = own.flow - moved<V>(tree, b, *v, mode) -
               transposed_times(coupling, turned_by(back, own.spin));
    for (int64_t c = 0; c < 2 && c < tree.n_coordinates[b]; c++) {
      const V rate = (*v)[tree.coordinate[b] + c];
      variance = variance + tree.spread[b] * rate * rate;
    }
  }
  own.own_force = drag_of(tree, b, own.flow, variance);
}

// Begin wrench and force of a branch with the wind's own, and add its moments.
template <class X, class V, class Out>
INLINE void begin(const sway_branches &tree, int64_t b, Load<X, V> &own, const Out &moments) {
  const double *mode = tree.load_mode + 3 * tree.keys * b;
  for (int64_t c = 0; c < tree.n_coordinates[b]; c++)
    add(moments, tree.coordinate[b] + c, dot(read(mode + 3 * c), own.own_force));
  own.wrench_force = turned_by(own.turn, own.own_force);
  own.wrench_moment = turned_by(own.turn, read_matrix(tree.coupling + 9 * b) * own.own_force);
}

// Hand the wrench of a branch to its parent, as moments on the key rotations as they are bent and
// turned. The load of a branch rotates with it, and its force and moment act on the parent at the bent
// position of its base: `go_outward` transposed.
template <class X, class V, class Out>
INLINE void go_inward(const sway_branches &tree, int64_t b, const Load<X, V> &own, Load<X, V> &on,
                      const Out &moments) {
  const Vector<V> force = turned_by(own.rotation, own.wrench_force);
  const Vector<V> couple = turned_by(own.rotation, own.wrench_moment);
  on.wrench_force += force;
  on.wrench_moment += couple + cross(own.arm, force);
  // The shortening of the arm, the spin, and the motion of the base.
  const V axial = 2.0 * tree.per_arm[b] * dot(read(tree.arm + 3 * b), force);
  const Vector<V> pull = force - axial * own.displacement;
  const Vector<V> turning =
      spin_by(-1.0 * own.rotation, couple) + cross(read(tree.base + 3 * b), pull);
  const double *twist = tree.twist + 6 * tree.keys * b;
  const int64_t parent = tree.parent[b];
  for (int64_t c = 0; c < tree.n_coordinates[parent]; c++, twist += 6)
    add(moments, tree.coordinate[parent] + c,
        dot(read(twist), pull) + dot(read(twist + 3), turning));
}

// Add the moments of a wind on the key rotations of a tree at x that moves at v, or is still.
template <class X, class V, class A, class B, class Out>
void add_moments(const sway_branches &tree, const A &x, const B *v, const double *mode,
                 const Vector<X> &wind, Load<X, V> *loads, const Out &moments) {
  loads[0] = Load<X, V>{};
  loads[0].orientation.w = 1.0 + X{};
  for (int64_t b = 0; b < tree.branches; b++) {
    if (b > 0) go_outward(tree, b, x, v, loads[tree.parent[b]], loads[b]);
    find_force(tree, b, x, v, mode, wind, loads[b]);
    begin(tree, b, loads[b], moments);
  }
  for (int64_t b = tree.branches - 1; b > 0; b--)
    go_inward(tree, b, loads[b], loads[tree.parent[b]], moments);
}

INLINE int64_t keys_of(const sway_branches &tree) {
  int64_t count = 0;
  for (int64_t b = 0; b < tree.branches; b++) count += tree.n_coordinates[b];
  return count;
}

}  // namespace
