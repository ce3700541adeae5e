// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
#include "limp_layout.h"

#include <math.h>

#include "turn.h"

namespace {

using namespace sway;

// Largest number of coordinates whose inertia is that of the pose, of models with a table.
constexpr int64_t LEADING = 120;

// Distance of a segment's points from its middle, over its length: half of 1 / sqrt(3).
constexpr double GAUSS = 0.28867513459481287;

// Largest key rotation [rad] of the differences for a column.
constexpr double COLUMN_TURN = 1e-5;

int64_t whole(int64_t count, int64_t together) {
  return (count + together - 1) / together * together;
}

double product(const double *a, const double *b, int64_t count) {
  double total = 0.0;
  for (int64_t i = 0; i < count; i++) total += a[i] * b[i];
  return total;
}

// The turn by which the difference for a column is taken.
double amount_of(const double *direction, int64_t count) {
  double steepest = 1e-300;
  for (int64_t i = 0; i < count; i++)
    if (fabs(direction[i]) > steepest) steepest = fabs(direction[i]);
  return COLUMN_TURN / steepest;
}

// Points of segments: roots of their masses, distances from the start, and drag areas. The area of a
// branch beyond that of its wood is leaves, spread evenly along it.
void lay_out_segments(const Arrays &a, Limp &limp) {
  const int64_t n = a.size[-SIZE_n];
  for (int64_t i = 0; i < limp.each; i++) limp.root_mass[i] = 1.0;
  for (int64_t branch = 0; branch < a.size[-SIZE_b]; branch++) {
    const int64_t first = a.branch_first[branch], end = a.branch_first[branch + 1];
    double of_wood = 0.0, along = 0.0;
    for (int64_t i = first; i < end; i++) {
      const Vector<double> apart = read(a.tree_end + 3 * i) - read(a.tree_start + 3 * i);
      const double length = sqrt(dot(apart, apart));
      const double of_segment = 0.5 * length * (a.tree_base_diameter[i] + a.tree_tip_diameter[i]);
      of_wood += of_segment;
      along += length;
      for (int64_t k = 0; k < POINTS; k++) {
        const int64_t point = k * n + i;
        limp.from_start[point] = length * (0.5 + (k ? GAUSS : -GAUSS));
        limp.root_mass[point] = sqrt(a.segment_mass[i] / POINTS);
        limp.gravity[point] = -*a.gravity * limp.root_mass[point];
        limp.speed[point] = a.branch_speed[branch];
        if (limp.delay) limp.delay[point] = a.limb_delay[branch];
        limp.area[point] = of_segment / POINTS;
      }
    }
    const double area = a.branch_area[branch];
    const double clad = of_wood > 0.0 ? fmin(area / of_wood, 1.0) : 0.0;
    const double leaves = along > 0.0 ? fmax(area - of_wood, 0.0) / along : 0.0;
    for (int64_t i = first; i < end; i++) {
      const double length = limp.from_start[i] + limp.from_start[n + i];
      for (int64_t point = i; point < POINTS * n; point += n)
        limp.area[point] = limp.area[point] * clad + length / POINTS * leaves;
    }
  }
}

// Replace rows, the first of which are leading, by the inverse of the factor times them.
void solve_lower(const Limp &limp, double *rows, int64_t count) {
  for (int64_t i = 0; i < limp.leading; i++) {
    const double *factor = limp.factor + i * limp.row;
    double *row = rows + i * count;
    for (int64_t k = 0; k < i; k++)
      for (int64_t j = 0; j < count; j++) row[j] -= factor[k] * rows[k * count + j];
    for (int64_t j = 0; j < count; j++) row[j] /= factor[i];
  }
}

// Decompose the inertia of leading columns, L L'; whether it is positive definite.
bool factorize(Limp &limp) {
  for (int64_t i = 0; i < limp.leading; i++)
    for (int64_t k = 0; k <= i; k++) {
      const double *own = limp.columns + i * limp.places, *other = limp.columns + k * limp.places;
      double *row = limp.factor + i * limp.row;
      const double *above = limp.factor + k * limp.row;
      const double left = product(own, other, limp.places) - product(row, above, k);
      if (k < i)
        row[k] = left / above[k];
      else if (left > 0.0 && isfinite(left))
        row[i] = sqrt(left);
      else
        return false;
    }
  return true;
}

// Find columns at rest by central differences, and the potential of the weight.
void place_at_rest(const sway_model &model, Limp &limp, Room &room) {
  const Frame &frame = frame_of_machine();
  const int64_t N = model.sizes.keys;
  LimpRoom &own = room.limp;
  for (int64_t i = 0; i < model.sizes.coordinates; i++) {
    const double *direction = limp.directions + i * limp.keys;
    const double amount = amount_of(direction, N);
    double *out[] = {own.ahead, own.behind};
    for (int side = 0; side < 2; side++) {
      for (int64_t key = 0; key < N; key++)
        own.keys[key] = (side ? -amount : amount) * direction[key];
      frame.find_place(model, room, own.keys, out[side], nullptr);
    }
    for (int64_t j = 0; j < limp.places; j++)
      limp.columns[i * limp.places + j] = (own.ahead[j] - own.behind[j]) / (2.0 * amount);
  }
  memset(own.keys, 0, limp.keys * sizeof(double));
  frame.find_place(model, room, own.keys, own.here, nullptr);
  limp.potential = product(limp.gravity, own.here + 2 * limp.each, limp.each);
}

// Write the force of the weight on some coordinates.
void find_weight(const Limp &limp, int64_t count, double *force) {
  for (int64_t i = 0; i < count; i++)
    force[i] = product(limp.gravity, limp.columns + i * limp.places + 2 * limp.each, limp.each);
}

}  // namespace

namespace sway {

bool has_pose(const Arrays &a) {
  if (!(a.segment_mass && a.weight_slopes && a.shapes && a.stiffness && a.own_damping &&
        a.drag_law && a.branch_area && a.branch_speed && a.gravity && a.tree_start))
    return false;
  for (int64_t i = 0; i < a.size[-SIZE_n]; i++)
    if (!(a.segment_mass[i] > 0.0)) return false;
  return a.size[-SIZE_m] > 0;
}

bool lay_out_limp(sway_model &model, const Arrays &a) {
  Memory &memory = model.memory;
  const int64_t m = model.sizes.coordinates, N = model.sizes.keys, M = model.padded;
  Limp &limp = model.limp;
  const int64_t q = model.table.levels && m > LEADING ? LEADING : m;
  limp.leading = q;
  limp.row = whole(q + 3, 16);
  limp.each = whole(POINTS * model.sizes.segments, 16);
  limp.places = 3 * limp.each;
  limp.keys = whole(N, 32);
  memory.take(m * limp.keys, limp.shapes, limp.directions);
  memory.take(m * limp.places, limp.columns);
  memory.take(q * limp.row, limp.factor);
  memory.take(m * M, limp.slopes, limp.all_slopes);
  memory.take(M, limp.amount, limp.weight, limp.force, limp.damping);
  memory.take(limp.each, limp.root_mass, limp.from_start, limp.area, limp.speed, limp.gravity);
  if (a.limb_delay) memory.take(limp.each, limp.delay);
  Memory scratch;
  Room room = {};
  const sway_model *models[] = {&model};
  open_room(scratch, models, 1, room);
  memory.is_short |= scratch.is_short;
  if (!memory.is_short) {
    lay_out_segments(a, limp);
    for (int64_t key = 0; key < N; key++)
      for (int64_t i = 0; i < m; i++)
        limp.shapes[(key / 32 * m + i) * 32 + key % 32] = limp.directions[i * limp.keys + key] =
            a.shapes[key * m + i];
    place_at_rest(model, limp, room);
  }
  scratch.release();
  if (memory.is_short) return false;
  for (int64_t i = 0; i < m; i++)
    memcpy(limp.all_slopes + i * M, a.weight_slopes + i * m, m * sizeof(double));
  memcpy(limp.slopes, limp.all_slopes, m * M * sizeof(double));
  find_weight(limp, m, limp.force);
  // The model's coordinates have unit mass, that of its points to some percent.
  if (!factorize(limp)) {
    limp.leading = 0;
    return false;
  }
  solve_lower(limp, limp.directions, limp.keys);
  solve_lower(limp, limp.columns, limp.places);
  solve_lower(limp, limp.slopes, M);
  find_weight(limp, q, limp.weight);
  for (int64_t i = 0; i < m; i++) {
    limp.amount[i] = amount_of(limp.directions + i * limp.keys, N);
    for (int64_t j = 0; j < limp.places; j++) {
      const int64_t point = j % limp.each;
      const double root = limp.root_mass[point], moved = limp.columns[i * limp.places + j];
      limp.damping[i] += 2.0 * limp.area[point] * limp.speed[point] / (root * root) * moved * moved;
    }
  }
  return true;
}

}  // namespace sway
