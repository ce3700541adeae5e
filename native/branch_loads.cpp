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
#include <string.h>

#include "frame.h"
#include "library.h"
#include "turn.h"

namespace {

typedef Vector<double> V3;

// Sum a mode (b, k, 3) of a branch by the amounts of its key rotations.
INLINE V3 moved(const sway_branches &tree, int64_t b, const double *amounts, const double *mode) {
  V3 sum = {0.0, 0.0, 0.0};
  const int64_t count = tree.n_coordinates[b];
  const double *own = amounts + tree.coordinate[b], *row = mode + 3 * tree.keys * b;
  for (int64_t c = 0; c < count; c++) sum += own[c] * read(row + 3 * c);
  return sum;
}

// Displacement and rotation vector of a base, or their rates, by its parent's key rotations.
struct Joint {
  V3 shift, rotation;
};

INLINE Joint joint_of(const sway_branches &tree, int64_t b, const double *amounts) {
  Joint joint = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
  const int64_t parent = tree.parent[b], count = tree.n_coordinates[parent];
  const double *own = amounts + tree.coordinate[parent], *twist = tree.twist + 6 * tree.keys * b;
  for (int64_t c = 0; c < count; c++) {
    joint.shift += own[c] * read(twist + 6 * c);
    joint.rotation += own[c] * read(twist + 6 * c + 3);
  }
  joint.shift += cross(joint.rotation, read(tree.base + 3 * b));
  return joint;
}

// The motion of all bases. A base keeps its distance from the parent's base, as the end of a rod:
// where it is displaced by s across an arm a, it comes closer by |s|^2 / (2 |a|).
void go_outward(const sway_branches &tree, const double *x, const double *v,
                sway_branch_load *loads) {
  memset(loads, 0, sizeof(*loads));
  loads[0].orientation[0] = 1.0;
  for (int64_t b = 1; b < tree.branches; b++) {
    sway_branch_load &own = loads[b];
    const sway_branch_load &on = loads[tree.parent[b]];
    const V3 rest_arm = read(tree.arm + 3 * b);
    const double per_arm = tree.per_arm[b];
    const Joint joint = joint_of(tree, b, x);
    const V3 arm = joint.shift + (1.0 - per_arm * dot(joint.shift, joint.shift)) * rest_arm;
    write(own.displacement, joint.shift);
    write(own.rotation, joint.rotation);
    write(own.arm, arm);
    const Quaternion<double> turned =
        product(read_quaternion(on.orientation), quaternion_of(joint.rotation));
    own.orientation[0] = turned.w;
    write(own.orientation + 1, {turned.x, turned.y, turned.z});
    if (!v) {
      memset(own.velocity, 0, sizeof(own.velocity));
      continue;
    }
    // In the frame of the parent's base, then in that of the base itself.
    const Joint rate = joint_of(tree, b, v);
    const V3 parent_spin = read(on.velocity + 3);
    const double shortening = 2.0 * per_arm * dot(joint.shift, rate.shift);
    const V3 velocity =
        read(on.velocity) + cross(parent_spin, arm) + rate.shift - shortening * rest_arm;
    const V3 spin = parent_spin + spin_by(joint.rotation, rate.rotation);
    write(own.velocity, turned_by(-1.0 * joint.rotation, velocity));
    write(own.velocity + 3, turned_by(-1.0 * joint.rotation, spin));
  }
}

// The force of the wind on a branch, |U_n| U_n times its area: U is the velocity of the air less
// that of the base, of the branch itself and of its spin, and U_n the part across its pieces.
void find_force(const sway_branches &tree, int64_t b, const double *x, const double *v,
                const V3 &wind, sway_branch_load &own) {
  const V3 air = tree.speed[b] * rotated(inverse(read_quaternion(own.orientation)), wind);
  const V3 turn = moved(tree, b, x, tree.load_rotation);
  const V3 back = -1.0 * turn;
  V3 u = turned_by(back, air - read(own.velocity));
  double spread = 0.0;
  if (v) {
    const V3 spin = turned_by(back, read(own.velocity + 3));
    const V3 by_spin = transposed_times(read_matrix(tree.coupling + 9 * b), spin);
    u = u - moved(tree, b, v, tree.damping_mode) - by_spin;
    const double *rate = v + tree.coordinate[b];
    for (int64_t c = 0; c < 2 && c < tree.n_coordinates[b]; c++)
      spread += tree.spread[b] * rate[c] * rate[c];
  }
  const V3 across = times_symmetric(tree.projector + 6 * b, u);
  const double speed = __builtin_sqrt(most(dot(u, across), 0.0) + spread);
  write(own.air, air);
  write(own.turn, turn);
  write(own.own_force, tree.area[b] * speed * across);
}

// Begin moments, wrench and force of a branch with the wind's own.
void begin(const sway_branches &tree, int64_t b, sway_branch_load &own, double *moments) {
  const V3 force = read(own.own_force), turn = read(own.turn);
  const double *mode = tree.load_mode + 3 * tree.keys * b;
  for (int64_t c = 0; c < tree.n_coordinates[b]; c++)
    moments[tree.coordinate[b] + c] = dot(read(mode + 3 * c), force);
  const V3 couple = read_matrix(tree.coupling + 9 * b) * force;
  const V3 at_base = turned_by(turn, force);
  write(own.wrench, at_base);
  write(own.wrench + 3, turned_by(turn, couple));
  write(own.force, rotated(read_quaternion(own.orientation), at_base));
}

// Turn forces into moments on the key rotations of a tree as it is bent and turned. The load of a
// branch rotates with it, and its force and moment act on the parent at the bent position of its
// base: `go_outward` transposed.
void go_inward(const sway_branches &tree, sway_branch_load *loads, double *moments) {
  for (int64_t b = 0; b < tree.branches; b++) begin(tree, b, loads[b], moments);
  for (int64_t b = tree.branches - 1; b > 0; b--) {
    const sway_branch_load &own = loads[b];
    const V3 rotation = read(own.rotation);
    const V3 force = turned_by(rotation, read(own.wrench));
    const V3 couple = turned_by(rotation, read(own.wrench + 3));
    const int64_t parent = tree.parent[b];
    double *total = loads[parent].wrench;
    write(total, read(total) + force);
    write(total + 3, read(total + 3) + couple + cross(read(own.arm), force));

    // The shortening of the arm, the spin, and the motion of the base.
    const double axial = 2.0 * tree.per_arm[b] * dot(read(tree.arm + 3 * b), force);
    const V3 pull = force - axial * read(own.displacement);
    const V3 turning = spin_by(-1.0 * rotation, couple) + cross(read(tree.base + 3 * b), pull);
    const double *twist = tree.twist + 6 * tree.keys * b;
    for (int64_t c = 0; c < tree.n_coordinates[parent]; c++)
      moments[tree.coordinate[parent] + c] +=
          dot(read(twist + 6 * c), pull) + dot(read(twist + 6 * c + 3), turning);
  }
}

}  // namespace

extern "C" {

void sway_wind_moments(const sway_branches *tree, const double *x, const double *v,
                       const double *winds, size_t count, sway_branch_load *loads,
                       double *moments) {
  int64_t n = 0;
  for (int64_t b = 0; b < tree->branches; b++) n += tree->n_coordinates[b];
  for (size_t pose = 0; pose < count; pose++) {
    const double *at = x + n * pose, *rate = v ? v + n * pose : nullptr;
    go_outward(*tree, at, rate, loads);
    for (int64_t b = 0; b < tree->branches; b++)
      find_force(*tree, b, at, rate, read(winds + 3 * pose), loads[b]);
    go_inward(*tree, loads, moments + n * pose);
  }
}

void sway_load_slopes(const sway_branches *tree, const sway_branch_load *loads,
                      const double *shapes, size_t columns, double *scratch, double *turning,
                      double *damping) {
  sway::frame_of_machine().load_slopes(*tree, loads, shapes, columns, scratch, turning, damping);
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
