// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
#include "limp_layout.h"

#include <math.h>

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
void lay_out_segments(Memory &memory, const Arrays &a, Limp &limp) {
  double *root_mass = memory.take<double>(limp.each);
  double *from_start = memory.take<double>(limp.each);
  double *area = memory.take<double>(limp.each);
  double *speed = memory.take<double>(limp.each);
  double *gravity = memory.take<double>(limp.each);
  int64_t *delay = a.limb_delay ? memory.take<int64_t>(limp.each) : nullptr;
  if (memory.is_short) return;
  const int64_t n = a.size[-SIZE_n];
  for (int64_t i = 0; i < limp.each; i++) root_mass[i] = 1.0;
  for (int64_t branch = 0; branch < a.size[-SIZE_b]; branch++) {
    const int64_t first = a.branch_first[branch], end = a.branch_first[branch + 1];
    double of_wood = 0.0, along = 0.0;
    for (int64_t i = first; i < end; i++) {
      double square = 0.0;
      for (int64_t axis = 3 * i; axis < 3 * i + 3; axis++) {
        const double apart = a.tree_end[axis] - a.tree_start[axis];
        square += apart * apart;
      }
      const double length = sqrt(square);
      const double of_segment = 0.5 * length * (a.tree_base_diameter[i] + a.tree_tip_diameter[i]);
      of_wood += of_segment;
      along += length;
      for (int64_t k = 0; k < POINTS; k++) {
        const int64_t point = k * n + i;
        from_start[point] = length * (0.5 + (k ? GAUSS : -GAUSS));
        root_mass[point] = sqrt(a.segment_mass[i] / POINTS);
        gravity[point] = -*a.gravity * root_mass[point];
        speed[point] = a.branch_speed[branch];
        if (delay) delay[point] = a.limb_delay[branch];
        area[point] = of_segment / POINTS;
      }
    }
    const double clad = of_wood > 0.0 ? fmin(a.branch_area[branch] / of_wood, 1.0) : 0.0;
    const double leaves = along > 0.0 ? fmax(a.branch_area[branch] - of_wood, 0.0) / along : 0.0;
    for (int64_t i = first; i < end; i++) {
      const double length = from_start[i] + from_start[n + i];
      for (int64_t point = i; point < POINTS * n; point += n)
        area[point] = area[point] * clad + length / POINTS * leaves;
    }
  }
  limp.root_mass = root_mass;
  limp.from_start = from_start;
  limp.area = area;
  limp.speed = speed;
  limp.gravity = gravity;
  limp.delay = delay;
}

// Replace rows, the first of which are leading, by the inverse of a factor times them.
void solve_lower(const double *factor, int64_t q, int64_t stride, double *rows, int64_t count) {
  for (int64_t i = 0; i < q; i++) {
    double *row = rows + i * count;
    for (int64_t k = 0; k < i; k++)
      for (int64_t j = 0; j < count; j++) row[j] -= factor[i * stride + k] * rows[k * count + j];
    for (int64_t j = 0; j < count; j++) row[j] /= factor[i * stride + i];
  }
}

// Decompose the inertia of leading columns, L L'; whether it is positive definite.
bool factorize(const double *columns, int64_t q, int64_t places, double *factor, int64_t stride) {
  for (int64_t i = 0; i < q; i++)
    for (int64_t k = 0; k <= i; k++) {
      double *row = factor + i * stride;
      const double *other = factor + k * stride;
      const double own = product(columns + i * places, columns + k * places, places);
      const double left = own - product(row, other, k);
      if (k < i)
        row[k] = left / other[k];
      else if (left > 0.0 && isfinite(left))
        row[i] = sqrt(left);
      else
        return false;
    }
  return true;
}

// Find columns at rest by central differences, and the potential of the weight.
void place_at_rest(const sway_model &model, Limp &limp, const double *directions, double *columns,
                   Room &room) {
  const Frame &frame = frame_of_machine();
  const int64_t N = model.sizes.keys;
  LimpRoom &own = room.limp;
  for (int64_t i = 0; i < model.sizes.coordinates; i++) {
    const double *direction = directions + i * limp.keys;
    const double amount = amount_of(direction, N);
    double *out[] = {own.ahead, own.behind};
    for (int side = 0; side < 2; side++) {
      for (int64_t key = 0; key < N; key++)
        own.keys[key] = (side ? -amount : amount) * direction[key];
      frame.find_place(model, room, own.keys, out[side], nullptr);
    }
    for (int64_t j = 0; j < limp.places; j++)
      columns[i * limp.places + j] = (own.ahead[j] - own.behind[j]) / (2.0 * amount);
  }
  memset(own.keys, 0, limp.keys * sizeof(double));
  frame.find_place(model, room, own.keys, own.here, nullptr);
  limp.potential = product(limp.gravity, own.here + 2 * limp.each, limp.each);
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
  const int64_t n = model.sizes.segments, m = model.sizes.coordinates, N = model.sizes.keys;
  const int64_t M = model.padded;
  Limp &limp = model.limp;
  const int64_t q = model.table.levels && m > LEADING ? LEADING : m;
  limp.leading = q;
  limp.row = whole(q + 3, 16);
  limp.each = whole(POINTS * n, 16);
  limp.places = 3 * limp.each;
  limp.keys = whole(N, 32);
  double *shapes = memory.take<double>(m * limp.keys);
  double *directions = memory.take<double>(m * limp.keys);
  double *amount = memory.take<double>(m);
  double *columns = memory.take<double>(m * limp.places);
  double *factor = memory.take<double>(q * limp.row);
  double *weight = memory.take<double>(q);
  double *slopes = memory.take<double>(q * M);
  double *force = memory.take<double>(M);
  double *all_slopes = memory.take<double>(m * M);
  double *damping = memory.take<double>(M);
  lay_out_segments(memory, a, limp);
  Memory scratch;
  Room room = {};
  const sway_model *models[] = {&model};
  open_room(scratch, models, 1, room);
  if (memory.is_short || scratch.is_short) {
    memory.is_short = true;
    scratch.release();
    return false;
  }
  for (int64_t key = 0; key < N; key++)
    for (int64_t i = 0; i < m; i++) {
      shapes[(key / 32 * m + i) * 32 + key % 32] = a.shapes[key * m + i];
      directions[i * limp.keys + key] = a.shapes[key * m + i];
    }
  for (int64_t i = 0; i < m; i++)
    memcpy(all_slopes + i * M, a.weight_slopes + i * m, m * sizeof(double));
  memcpy(slopes, all_slopes, q * M * sizeof(double));
  place_at_rest(model, limp, directions, columns, room);
  scratch.release();
  const double *height = columns + 2 * limp.each;
  for (int64_t i = 0; i < m; i++)
    force[i] = product(limp.gravity, height + i * limp.places, limp.each);
  // The model's coordinates have unit mass, that of its points to some percent.
  if (!factorize(columns, q, limp.places, factor, limp.row)) {
    limp.leading = 0;
    return false;
  }
  solve_lower(factor, q, limp.row, directions, limp.keys);
  solve_lower(factor, q, limp.row, columns, limp.places);
  solve_lower(factor, q, limp.row, slopes, M);
  for (int64_t i = 0; i < q; i++)
    weight[i] = product(limp.gravity, height + i * limp.places, limp.each);
  for (int64_t i = 0; i < m; i++) {
    amount[i] = amount_of(directions + i * limp.keys, N);
    for (int64_t j = 0; j < limp.places; j++) {
      const int64_t segment = j % limp.each;
      const double root = limp.root_mass[segment], moved = columns[i * limp.places + j];
      damping[i] += 2.0 * limp.area[segment] * limp.speed[segment] / (root * root) * moved * moved;
    }
  }
  limp.shapes = shapes;
  limp.directions = directions;
  limp.amount = amount;
  limp.columns = columns;
  limp.factor = factor;
  limp.weight = weight;
  limp.slopes = slopes;
  limp.force = force;
  limp.all_slopes = all_slopes;
  limp.damping = damping;
  return true;
}

}  // namespace sway
