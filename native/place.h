// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// From key rotations to poses ("A pose" of doc/sway_model.md).
//
// Sixteen branches are placed at a time, parents before their children: first orientation and
// position of the bases, then one segment after the other of the sixteen branches. All angles are
// half angles, as quaternions have them.
#pragma once

#include "frame.h"
#include "vec.h"

namespace {

using namespace sway;

constexpr double BLEND_FROM = 30.0 * DEGREE * 30.0 * DEGREE;
constexpr double BLEND_TO = 45.0 * DEGREE * 45.0 * DEGREE;
constexpr double STRETCH_TO = 90.0 * DEGREE * 90.0 * DEGREE;

// Rows of sixteen slots.
struct Slots {
  explicit Slots(double *memory, int64_t rows)
      : row(reinterpret_cast<Row *>(memory)), key(row), parent_base(row + 2), support(row + 10),
        base(row + 17), half_rotation(row + 25), times_half(row + 28), start(row + 32),
        pose(row + 35), blend(row[42]), rotation_square(row[43]), parent_key(row + 48),
        half_key(row + 48 + rows) {}

  Row *row;
  Row *key;            // first two key rotations
  Row *parent_base;    // of `Room::bases`
  Row *support;        // pose of the base segment
  Row *base;           // orientation w x y z, then half of what children turn by (2)
  Row *half_rotation;  // half the rotation vector per unit of slope
  Row *times_half;     // quaternion of the base times half_rotation
  Row *start;          // of the next segment
  Row *pose;           // of the segment, as in messages
  double *blend;       // share of the slope under a load at the tip
  double *rotation_square;
  Row *parent_key;  // key rotations of the parent, from the third on
  Row *half_key;    // half of each key rotation, stretched
};

INLINE Quaternion<Vec> load_quaternion(const Row *rows, int slot) {
  return {load(rows[0] + slot), load(rows[1] + slot), load(rows[2] + slot), load(rows[3] + slot)};
}

INLINE void store_quaternion(Row *rows, int slot, const Quaternion<Vec> &q) {
  store(rows[0] + slot, q.w);
  store_vector(rows + 1, slot, {q.x, q.y, q.z});
}

// Read four numbers of each of four rows of an array into slots.
INLINE void take_four(const double *array, int64_t stride, const int64_t *rows, int first,
                      Row *slots, int slot) {
  Four a = load_four(array + rows[slot] * stride + first);
  Four b = load_four(array + rows[slot + 1] * stride + first);
  Four c = load_four(array + rows[slot + 2] * stride + first);
  Four d = load_four(array + rows[slot + 3] * stride + first);
  transpose(a, b, c, d);
  store_four(slots[0] + slot, a);
  store_four(slots[1] + slot, b);
  store_four(slots[2] + slot, c);
  store_four(slots[3] + slot, d);
}

// Write four numbers of four slots to rows of an array.
INLINE void put_four(const Row *slots, int slot, double *array, int64_t stride, const int64_t *rows,
                     int64_t ahead, int first) {
  Four a = load_four(slots[0] + slot);
  Four b = load_four(slots[1] + slot);
  Four c = load_four(slots[2] + slot);
  Four d = load_four(slots[3] + slot);
  transpose(a, b, c, d);
  store_four(array + (rows[slot] + ahead) * stride + first, a);
  store_four(array + (rows[slot + 1] + ahead) * stride + first, b);
  store_four(array + (rows[slot + 2] + ahead) * stride + first, c);
  store_four(array + (rows[slot + 3] + ahead) * stride + first, d);
}

// The orientation of a pose, whose real part is the last.
INLINE Quaternion<Vec> orientation_of(const Row *pose, int slot) {
  const Vector<Vec> imaginary = load_vector(pose + 3, slot);
  return {load(pose[6] + slot), imaginary.x, imaginary.y, imaginary.z};
}

// The point at a length along the x axis of a pose.
INLINE Vector<Vec> along(const Row *pose, int slot, Vec length) {
  const Quaternion<Vec> q = orientation_of(pose, slot);
  const Vec twice = length + length;
  return {load(pose[0] + slot) + length - twice * (q.y * q.y + q.z * q.z),
          load(pose[1] + slot) + twice * (q.x * q.y + q.w * q.z),
          load(pose[2] + slot) + twice * (q.x * q.z - q.w * q.y)};
}

// Add the parts across the x axes of points in the frames of poses.
void go_aside(const Row *pose, Row *point, double scale, const Row *local, int count) {
  for (int slot = 0; slot < count; slot += LANES) {
    const Vector<Vec> aside = {Vec{}, load(local[1] + slot), load(local[2] + slot)};
    const Vector<Vec> turned = rotated(orientation_of(pose, slot), aside);
    store_vector(point, slot, load_vector(point, slot) + scale * turned);
  }
}

INLINE void read_keys(const Block &block, Slots &slots, const double *keys, int count) {
  for (int slot = 0; slot < count; slot++) {
    const double *own = keys + block.coordinate[slot];
    slots.key[0][slot] = own[0];
    slots.key[1][slot] = own[1];
  }
}

// Put the ground, at the root node and turned about the vertical, in place of a parent.
void stand_on_ground(Slots &slots, const Place &place) {
  for (int slot = 0; slot < WIDTH; slot++) {
    for (int row = 0; row < 8; row++) slots.parent_base[row][slot] = 0.0;
    slots.parent_base[0][slot] = place.cosine;
    slots.parent_base[3][slot] = place.sine;
    for (int axis = 0; axis < 3; axis++) slots.support[axis][slot] = place.at[axis];
    slots.support[3][slot] = slots.support[4][slot] = 0.0;
    slots.support[5][slot] = place.sine;
    slots.support[6][slot] = place.cosine;
  }
}

// Read the key rotations of four branches from the third on, or values after their last ones.
INLINE void read_further(const double *keys, const int64_t *first, Row *out, int64_t n_rows,
                         int slot) {
  for (int64_t from = 2; from < n_rows; from += 4)
    take_four(keys, 1, first, int(from), out + from, slot);
}

INLINE void read_parents(const Block &block, Slots &slots, const Room &room, const double *poses) {
  for (int slot = 0; slot < block.n_slots; slot += 4) {
    take_four(poses, 7, block.base_segment, 0, slots.support, slot);
    take_four(poses, 7, block.base_segment, 3, slots.support + 3, slot);
    take_four(room.bases, 8, block.parent, 0, slots.parent_base, slot);
    take_four(room.bases, 8, block.parent, 4, slots.parent_base + 4, slot);
    if (block.n_parent_rows > 2)
      read_further(room.keys, block.parent_coordinate, slots.parent_key, block.n_parent_rows, slot);
  }
}

// Half of what a key rotation turns the base of its children and its own segments by, stretched so
// that the chord has the angle of the key rotation.
struct Stretch {
  Vec carrying, own, blend;
};

INLINE Stretch stretched(Vec square, Vec skew, Vec tip_skew) {
  const Vec blend = least(most((square - BLEND_FROM) / (BLEND_TO - BLEND_FROM), Vec{}), all(1.0));
  const Vec half_square = 0.5 * least(square, all(STRETCH_TO));
  const Vec carrying = 0.5 + half_square * skew;
  return {carrying, carrying + half_square * blend * tip_skew, blend};
}

// Rotate and place the bases of the branches, and set how they bend. Returns a bound on the squared
// half angle of any segment.
INLINE double rotate_bases(const Block &block, Slots &slots, double scale, const double *keys,
                           int count) {
  if (block.n_rows > 2)
    for (int slot = 0; slot < count; slot += 4)
      read_further(keys, block.coordinate, slots.half_key, block.n_rows, slot);
  Vec bound = {};
  for (int slot = 0; slot < count; slot += LANES) {
    const Row *turn = reinterpret_cast<const Row *>(block.base_rotation);
    const Vec half_x = load(slots.parent_base[4] + slot);
    const Vec half_y = load(slots.parent_base[5] + slot);
    Vector<Vec> on_parent = half_x * load_vector(turn, slot) + half_y * load_vector(turn + 3, slot);
    for (int64_t row = 2; row < block.n_parent_rows; row++)
      on_parent += 0.5 * load(slots.parent_key[row] + slot) * load_vector(turn + 3 * row, slot);
    const Vec square = dot(on_parent, on_parent);
    const Quaternion<Vec> turned = quaternion_of(half_angle(square, largest(square)), on_parent);
    const Quaternion<Vec> base = product(load_quaternion(slots.parent_base, slot), turned);

    const Vec x = load(slots.key[0] + slot), y = load(slots.key[1] + slot);
    const Vec key_square = x * x + y * y;
    const Stretch stretch =
        stretched(key_square, load(block.skew + slot), load(block.tip_skew + slot));
    // x turns the chord about the axis e2 of the branch, y about -e1.
    const Vector<Vec> rotation = stretch.own * x * load_vector(block.axes[1], slot) +
                                 -(stretch.own * y) * load_vector(block.axes[0], slot);
    store_quaternion(slots.base, slot, base);
    store(slots.base[4] + slot, stretch.carrying * x);
    store(slots.base[5] + slot, stretch.carrying * y);
    store(slots.half_key[0] + slot, stretch.own * x);
    store(slots.half_key[1] + slot, stretch.own * y);
    store(slots.blend + slot, stretch.blend);
    store_vector(slots.half_rotation, slot, rotation);
    store_quaternion(slots.times_half, slot, product(base, rotation));
    store_vector(slots.start, slot,
                 along(slots.support, slot, scale * load(block.offset[0] + slot)));

    const Vec rotation_square = stretch.own * stretch.own * key_square;
    store(slots.rotation_square + slot, rotation_square);
    const Row *steepest = reinterpret_cast<const Row *>(block.steepest);
    Vec total = rotation_square * load(steepest[0] + slot);
    if (block.n_rows > 2) {
      for (int64_t row = 2; row < block.n_rows; row++) {
        const Vec further = 0.5 * load(slots.half_key[row] + slot);
        store(slots.half_key[row] + slot, further);
        total += further * further * load(steepest[row] + slot);
      }
      // The square of a sum of n is at most n times the sum of the squares.
      total *= load(block.bound_factor + slot);
    }
    bound = most(bound, total);
  }
  if (!block.is_at_axes) go_aside(slots.support, slots.start, scale, block.offset, count);
  return largest(bound);
}

// Write the bases for the children.
INLINE void write_bases(const Block &block, const Slots &slots, double *bases) {
  const int64_t in_fours = block.n_parents / 4 * 4;
  for (int slot = 0; slot < in_fours; slot += 4) {
    put_four(slots.base, slot, bases, 8, block.branch, 0, 0);
    put_four(slots.base + 4, slot, bases, 8, block.branch, 0, 4);
  }
  for (int64_t slot = in_fours; slot < block.n_parents; slot++)
    for (int row = 0; row < 6; row++) bases[8 * block.branch[slot] + row] = slots.base[row][slot];
}

// Turn a segment from rest, begin it where the one before ended, and find its end.
INLINE void join(const Segment &segment, Slots &slots, double scale, int slot,
                 const Quaternion<Vec> &turned) {
  const Quaternion<Vec> q = product(turned, load_quaternion(segment.rest, slot));
  store_vector(slots.pose, slot, load_vector(slots.start, slot));
  store_vector(slots.pose + 3, slot, {q.x, q.y, q.z});
  store(slots.pose[6] + slot, q.w);
  store_vector(slots.start, slot, along(slots.pose, slot, scale * load(segment.chord[0] + slot)));
}

// Segments of branches that bend by their first two key rotations alone.
INLINE void bend_plain(const Segment &segment, Slots &slots, double scale, bool has_blend,
                       double bound, int count) {
  for (int slot = 0; slot < count; slot += LANES) {
    Vec slope = load(segment.slope + slot);
    if (has_blend) slope += load(slots.blend + slot) * load(segment.tip_slope + slot);
    const Vec square = slope * slope * load(slots.rotation_square + slot);
    const HalfAngle<Vec> half = half_angle(square, bound);
    const Vec sine = slope * half.sinc;
    const Quaternion<Vec> base = load_quaternion(slots.base, slot);
    const Quaternion<Vec> times = load_quaternion(slots.times_half, slot);
    join(segment, slots, scale, slot,
         {half.cosine * base.w + sine * times.w, half.cosine * base.x + sine * times.x,
          half.cosine * base.y + sine * times.y, half.cosine * base.z + sine * times.z});
  }
}

// Segments of branches that bend by further key rotations.
INLINE void bend_by_all(const Segment &segment, Slots &slots, double scale, int64_t n_rows,
                        double bound, int count) {
  const Row *turn = reinterpret_cast<const Row *>(segment.turn);
  for (int slot = 0; slot < count; slot += LANES) {
    const Vec slope = load(slots.blend + slot) * load(segment.tip_slope + slot);
    Vector<Vec> half = slope * load_vector(slots.half_rotation, slot);
    for (int64_t row = 0; row < n_rows; row++)
      half += load(slots.half_key[row] + slot) * load_vector(turn + 3 * row, slot);
    const Quaternion<Vec> bend = quaternion_of(half_angle(dot(half, half), bound), half);
    join(segment, slots, scale, slot, product(load_quaternion(slots.base, slot), bend));
  }
}

INLINE void write_poses(const Block &block, const Slots &slots, int64_t rank, int64_t n_slots,
                        double *poses) {
  const int64_t in_fours = n_slots / 4 * 4;
  for (int slot = 0; slot < in_fours; slot += 4) {
    put_four(slots.pose, slot, poses, 7, block.first, rank, 0);
    put_four(slots.pose + 3, slot, poses, 7, block.first, rank, 3);
  }
  for (int64_t slot = in_fours; slot < n_slots; slot++)
    for (int row = 0; row < 7; row++)
      poses[7 * (block.first[slot] + rank) + row] = slots.pose[row][slot];
}

// Write some lines of the poses of the tree before.
INLINE void write_late(Late &late, int64_t lines) {
  if (!PASSES_CACHES || !late.lines) return;
  if (lines > late.lines) lines = late.lines;
  late.lines -= lines;
  for (; lines > 0; lines--, late.from += Late::LINE, late.to += Late::LINE)
    copy_past(late.from, late.to);
}

// Place every segment by the key rotations in the room.
void place(const sway_model &model, const Place &where, Room &room, double *poses, Late &late) {
  Slots slots(room.slots, model.rows + 4);
  for (int64_t number = 0; number < model.n_blocks; number++) {
    const Block &block = model.blocks[number];
    const int count = int((block.n_slots + LANES - 1) / LANES * LANES);
    read_keys(block, slots, room.keys, count);
    if (block.parent[0] < 0)
      stand_on_ground(slots, where);
    else
      read_parents(block, slots, room, poses);
    const double bound = rotate_bases(block, slots, where.scale, room.keys, count);
    write_bases(block, slots, room.bases);
    Vec blends = {};
    for (int slot = 0; slot < count; slot += LANES) blends = most(blends, load(slots.blend + slot));
    const bool has_blend = largest(blends) > 0.0;
    for (int64_t rank = 0; rank < block.n_records; rank++) {
      const Segment &segment = model.segments[block.first_record + rank];
      if (block.n_rows > 2)
        bend_by_all(segment, slots, where.scale, block.n_rows, bound, count);
      else
        bend_plain(segment, slots, where.scale, has_blend, bound, count);
      if (!block.is_joined) go_aside(slots.pose, slots.start, where.scale, segment.chord, count);
      write_poses(block, slots, rank, segment.n_slots, poses);
      write_late(late, segment.n_slots);
    }
  }
  write_late(late, late.lines);
}

// Write the key rotations of a state to the room: shapes times what is shown of the coordinates. The
// shapes of a tree of many branches are its largest table: they are summed in single precision.
void find_keys(const sway_model &model, const State &state, Room &room) {
  const int64_t m = model.sizes.coordinates;
  const int64_t n_shown = m - count_of(*state.left_out, m);
  for (int64_t i = 0; i < n_shown; i++) room.shown[i] = float(state.eta[i] - state.hidden[i]);
  constexpr int PARTS = LANES < 8 ? 8 : 4, SINGLES = 2 * LANES, TOGETHER = PARTS * SINGLES;
  for (int64_t first = 0; first < model.sizes.keys; first += TOGETHER) {
    const float *shapes = model.shapes + first / 64 * m * 64 + first % 64;
    Singles keys[PARTS] = {};
    for (int64_t i = 0; i < n_shown; i++)
      for (int part = 0; part < PARTS; part++)
        keys[part] += room.shown[i] * load(shapes + 64 * i + part * SINGLES);
    for (int part = 0; part < PARTS; part++) {
      store(room.single_keys, keys[part]);
      double *out = room.keys + first + part * SINGLES;
      for (int half = 0; half < SINGLES; half += LANES)
        store(out + half, load_singles(room.single_keys + half));
    }
  }
}

}  // namespace
