// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Derivatives of the wind load on a bent tree that is still, along shapes of motion: the passes of
// branch_loads.cpp differentiated by hand, a lane for each shape.
//
// Two kinds of terms add up. Joints: how the base of each branch moves on its parent's, and how the
// constant force and moment at the joint change as the parent or the joint itself moves. Loads: how
// the wind load of each branch changes as the branch turns and moves. Where the tree rotates below
// a constant force, the force does work on other key rotations as well; in a storm that part is as
// large as the change of the force.
//
// Damping takes energy from every motion. A branch is loaded where it works, at the mean of its
// motion, and damped at that same mean. What the drag on all its points takes more than that, the
// excess, damps its own first key rotations, each by itself.
//
// Twists are velocity and spin, wrenches force and moment, both about the root node and in the
// frame of the tree unless it is said. Maps of rotation vectors are taken to second order.
#pragma once

#include <string.h>

#include "library.h"
#include "turn.h"

namespace {

typedef Vector<double> V3;
typedef Vector<Vec> Lanes3;

// Where a branch is at present, and what acts on it.
struct Held {
  Matrix parent_frame;  // of the base of its parent
  Matrix frame;  // of its base
  V3 place;  // of its base [m]
  V3 force, moment;  // at the joint; the moment is about the root node
  V3 local_force, local_moment;  // the same in the frame of the parent, about the joint
  double along_arm;  // force times the arm at rest
  Matrix own_frame;  // of its loaded pieces
  Matrix drag;  // change of the force by the air velocity, in that frame
  V3 air;  // wind in that frame
  V3 own_moment;  // of the force about the base, in that frame
};

// Motion of a branch by each shape, and the change of the load that it hands to its parent.
struct Moved {
  Lanes3 velocity, spin;  // twist of the base
  Lanes3 shift, rotation;  // displacement of the base on its parent without the shortening, and
  // the change of its rotation vector, in the frame of the parent
  Lanes3 force, moment;  // wrench by the motion
  Lanes3 damping, damping_moment;  // wrench by its rate
};

static_assert(sizeof(Held) + sizeof(Moved) <= 256 * sizeof(double), "sway_load_slopes");

INLINE Matrix matrix_of(const Quaternion<double> &q) {
  const double x = 2.0 * q.x, y = 2.0 * q.y, z = 2.0 * q.z;
  return {{1.0 - y * q.y - z * q.z, x * q.y - z * q.w, x * q.z + y * q.w},
          {x * q.y + z * q.w, 1.0 - x * q.x - z * q.z, y * q.z - x * q.w},
          {x * q.z - y * q.w, y * q.z + x * q.w, 1.0 - x * q.x - y * q.y}};
}

INLINE Quaternion<double> orientation_of(const sway_branch_load &load) {
  const double *q = load.orientation;
  return {q[0], q[1], q[2], q[3]};
}

// Of the drag area |P u| P u by u: area (|P u| P + P u (P u)^T / |P u|).
INLINE Matrix drag_slope(const double *p, double area, const V3 &air) {
  const V3 across = times_symmetric(p, air);
  const double speed = __builtin_sqrt(most(dot(air, across), 0.0));
  const double share = area / most(speed, 1e-12), whole = area * speed;
  const V3 shared = share * across;
  return {whole * V3{p[0], p[3], p[4]} + shared.x * across,
          whole * V3{p[3], p[1], p[5]} + shared.y * across,
          whole * V3{p[4], p[5], p[2]} + shared.z * across};
}

static void hold(const sway_branches &tree, const sway_branch_load *loads, Held *held) {
  for (int64_t b = 0; b < tree.branches; b++) {
    const sway_branch_load &load = loads[b];
    Held &own = held[b];
    const Quaternion<double> orientation = orientation_of(load);
    own.frame = matrix_of(orientation);
    if (b > 0) {
      const Held &on = held[tree.parent[b]];
      own.parent_frame = on.frame;
      own.place = on.place + on.frame * read(load.arm);
    } else {
      own.parent_frame = matrix_of({1.0, 0.0, 0.0, 0.0});
      own.place = {0.0, 0.0, 0.0};
    }
    own.force = own.frame * read(load.wrench);
    const V3 moment = own.frame * read(load.wrench + 3);
    own.moment = moment + cross(own.place, own.force);
    own.local_force = transposed_times(own.parent_frame, own.force);
    own.local_moment = transposed_times(own.parent_frame, moment);
    own.along_arm = dot(read(tree.arm + 3 * b), own.local_force);
    const Quaternion<double> turn = quaternion_of(read(load.turn));
    own.own_frame = matrix_of(product(orientation, turn));
    own.air = transposed_times(own.own_frame, own.frame * read(load.air));
    own.drag = drag_slope(tree.projector + 6 * b, tree.area[b], own.air);
    own.own_moment = read_matrix(tree.coupling + 9 * b) * read(load.own_force);
  }
}

INLINE Lanes3 along(const double *row, size_t columns, int64_t count, const double *mode,
                    int width) {
  Lanes3 sum = {};
  for (int64_t c = 0; c < count; c++)
    sum += load(row + c * columns) * lanes_of(read(mode + c * width));
  return sum;
}

// The motion of the base of each branch along the shapes.
INLINE void move_outward(const sway_branches &tree, const sway_branch_load *loads,
                         const double *shapes, size_t columns, const Held *held, Moved *moved) {
  moved[0] = Moved{};
  for (int64_t b = 1; b < tree.branches; b++) {
    const Held &own = held[b];
    const int64_t parent = tree.parent[b];
    const double *row = shapes + tree.coordinate[parent] * columns;
    const int64_t count = tree.n_coordinates[parent];
    const double *twist = tree.twist + 6 * tree.keys * b;
    const Lanes3 rotation = along(row, columns, count, twist + 3, 6);
    const Lanes3 shift =
        along(row, columns, count, twist, 6) + cross(rotation, lanes_of(read(tree.base + 3 * b)));
    const V3 displacement = read(loads[b].displacement);
    const Vec closer = 2.0 * tree.per_arm[b] * dot(lanes_of(displacement), shift);
    const Lanes3 slide = shift - closer * lanes_of(read(tree.arm + 3 * b));
    const Lanes3 spin = own.parent_frame * spin_by(lanes_of(read(loads[b].rotation)), rotation);
    Moved &to = moved[b];
    const Moved &on = moved[parent];
    to.force = to.moment = to.damping = to.damping_moment = Lanes3{};
    to.shift = shift;
    to.rotation = rotation;
    to.spin = on.spin + spin;
    to.velocity = on.velocity + own.parent_frame * slide + cross(lanes_of(own.place), spin);
  }
}

// Add the changes of the wind load of a branch to its own key rotations, and to its wrenches.
INLINE void load_own(const sway_branches &tree, int64_t b, const sway_branch_load &load_of,
                     const double *shapes, size_t columns, const Held &own, Moved &to,
                     double *turning, double *damping) {
  const int64_t first = tree.coordinate[b] * columns, count = tree.n_coordinates[b];
  const double *mode = tree.load_mode + 3 * tree.keys * b;
  const Matrix coupling = read_matrix(tree.coupling + 9 * b);
  // In the frame of the loaded pieces, about the base.
  const Lanes3 place = lanes_of(own.place);
  const Lanes3 velocity = transposed_times(own.own_frame, to.velocity + cross(to.spin, place));
  const Lanes3 spin = transposed_times(own.own_frame, to.spin);
  const Lanes3 rotation =
      along(shapes + first, columns, count, tree.load_rotation + 3 * tree.keys * b, 3);
  const Lanes3 turned = spin_by(lanes_of(-1.0 * read(load_of.turn)), rotation) + spin;
  const Lanes3 loaded =
      transposed_times(coupling, spin) + velocity + along(shapes + first, columns, count, mode, 3);
  const Lanes3 constant = lanes_of(read(load_of.own_force));
  const Lanes3 by_turn = own.drag * cross(lanes_of(own.air), turned);
  const Lanes3 force = by_turn - cross(constant, turned);
  const Lanes3 couple =
      coupling * by_turn - cross(lanes_of(own.own_moment), turned) - cross(constant, velocity);
  const Lanes3 by_rate = -1.0 * (own.drag * loaded);
  const Lanes3 at_root = own.own_frame * force, by_rate_at_root = own.own_frame * by_rate;
  to.force += at_root;
  to.moment += own.own_frame * couple + cross(place, at_root);
  to.damping += by_rate_at_root;
  to.damping_moment += own.own_frame * (coupling * by_rate) + cross(place, by_rate_at_root);
  for (int64_t c = 0; c < count; c++) {
    double excess = 0.0;
    if (c < 2) {
      const V3 at = read(mode + 3 * c);
      const V3 beyond = read(tree.damping_mode + 3 * (tree.keys * b + c)) - at;
      excess = most(dot(at, own.drag * beyond), 0.0);
    }
    const int64_t row = first + c * columns;
    const Lanes3 of_mode = lanes_of(read(mode + 3 * c));
    store(turning + row, load(turning + row) + dot(of_mode, by_turn));
    store(damping + row, load(damping + row) + dot(of_mode, by_rate) - excess * load(shapes + row));
  }
}

// What a wrench at the base of a branch does on the key rotations of its parent.
INLINE void hand_to_parent(const sway_branches &tree, int64_t b, size_t columns,
                           const Lanes3 &on_shift, const Lanes3 &on_rotation, double *out) {
  const int64_t parent = tree.parent[b];
  const double *twist = tree.twist + 6 * tree.keys * b;
  const Lanes3 turning = on_rotation + cross(lanes_of(read(tree.base + 3 * b)), on_shift);
  double *row = out + tree.coordinate[parent] * columns;
  for (int64_t c = 0; c < tree.n_coordinates[parent]; c++, row += columns, twist += 6)
    store(row, load(row) + dot(lanes_of(read(twist)), on_shift) +
                   dot(lanes_of(read(twist + 3)), turning));
}

// What a wrench about the root does on the slide of a joint, in the frame of the parent.
INLINE Lanes3 on_shift_of(const sway_branches &tree, int64_t b, const sway_branch_load &load,
                          const Lanes3 &on_slide) {
  const Vec axial = 2.0 * tree.per_arm[b] * dot(lanes_of(read(tree.arm + 3 * b)), on_slide);
  return on_slide - axial * lanes_of(read(load.displacement));
}

// Sum the wrenches over subtrees, and find what they do at the joints.
INLINE void sum_inward(const sway_branches &tree, const sway_branch_load *loads,
                       const double *shapes, size_t columns, const Held *held, Moved *moved,
                       double *turning, double *damping) {
  for (int64_t b = tree.branches - 1; b >= 0; b--) {
    const Held &own = held[b];
    load_own(tree, b, loads[b], shapes, columns, own, moved[b], turning, damping);
    if (b == 0) break;
    const Moved &from = moved[b];
    Moved &on = moved[tree.parent[b]];
    on.force += from.force;
    on.moment += from.moment;
    on.damping += from.damping;
    on.damping_moment += from.damping_moment;

    const Lanes3 place = lanes_of(own.place);
    const Lanes3 back = lanes_of(-1.0 * read(loads[b].rotation));
    {
      const Lanes3 on_slide = transposed_times(own.parent_frame, from.damping);
      const Lanes3 on_spin =
          transposed_times(own.parent_frame, from.damping_moment + cross(from.damping, place));
      hand_to_parent(tree, b, columns, on_shift_of(tree, b, loads[b], on_slide),
                     spin_by(back, on_spin), damping);
    }
    // The parent turns under the constant force and moment at the joint.
    const Lanes3 constant = lanes_of(own.force);
    const Lanes3 force = from.force + cross(constant, on.spin);
    const Lanes3 moment =
        from.moment + cross(constant, on.velocity) + cross(lanes_of(own.moment), on.spin);
    // The joint itself moves: its slide under the spin, then the second derivatives of slide and
    // spin, times force and moment in the frame of the parent.
    const Lanes3 rotation = lanes_of(read(loads[b].rotation));
    const Lanes3 couple = lanes_of(own.local_moment);
    const V3 displacement = read(loads[b].displacement);
    const Vec closer = 2.0 * tree.per_arm[b] * dot(lanes_of(displacement), from.shift);
    const Lanes3 slide = from.shift - closer * lanes_of(read(tree.arm + 3 * b));
    const Lanes3 on_slide = transposed_times(own.parent_frame, force);
    const Lanes3 on_spin = transposed_times(own.parent_frame, moment + cross(force, place)) +
                           cross(lanes_of(own.local_force), slide);
    const Lanes3 second = cross(couple, cross(rotation, from.rotation)) -
                          2.0 * cross(rotation, cross(couple, from.rotation));
    const double shortening = 2.0 * tree.per_arm[b] * own.along_arm;
    hand_to_parent(
        tree, b, columns, on_shift_of(tree, b, loads[b], on_slide) - shortening * from.shift,
        spin_by(back, on_spin) + 0.5 * cross(couple, from.rotation) + (1.0 / 6.0) * second,
        turning);
  }
}

static void load_slopes(const sway_branches &tree, const sway_branch_load *loads,
                        const double *shapes, size_t columns, double *scratch, double *turning,
                        double *damping) {
  const uintptr_t first = reinterpret_cast<uintptr_t>(scratch) + alignof(Moved) - 1;
  Moved *moved = reinterpret_cast<Moved *>(first / alignof(Moved) * alignof(Moved));
  Held *held = reinterpret_cast<Held *>(moved + tree.branches);
  hold(tree, loads, held);
  int64_t n = 0;
  for (int64_t b = 0; b < tree.branches; b++) n += tree.n_coordinates[b];
  memset(turning, 0, n * columns * sizeof(double));
  memset(damping, 0, n * columns * sizeof(double));
  for (size_t i = 0; i < columns; i += LANES) {
    move_outward(tree, loads, shapes + i, columns, held, moved);
    sum_inward(tree, loads, shapes + i, columns, held, moved, turning + i, damping + i);
  }
}

}  // namespace
