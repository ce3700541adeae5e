// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Derivatives of the wind load on a bent tree that is still, along shapes of motion: the passes of
// branch_loads.h by numbers that carry their changes, a lane for each shape (forward mode of Griewank &
// Walther 2008, Evaluating Derivatives, chapter 3).
//
// Damping takes energy from every motion. A branch is loaded where it works, at the mean of its
// motion, and damped at that same mean. What the drag on all its points takes more than that, the
// excess, damps its own first key rotations, each by itself.
#pragma once

#include <string.h>

#include "branch_loads.h"

namespace {

struct Changing {
  double value;
  VecAt change;
};

INLINE Changing operator+(const Changing &a, const Changing &b) {
  return {a.value + b.value, a.change + b.change};
}
INLINE Changing operator+(double a, const Changing &b) { return {a + b.value, b.change}; }
INLINE Changing operator+(const Changing &a, double b) { return {a.value + b, a.change}; }
INLINE Changing operator*(const Changing &a, const Changing &b) {
  return {a.value * b.value, a.value * b.change + b.value * a.change};
}
INLINE Changing operator*(double a, const Changing &b) { return {a * b.value, a * b.change}; }
INLINE Changing operator*(const Changing &a, double b) { return b * a; }
INLINE Changing operator-(const Changing &a) { return -1.0 * a; }
INLINE Changing operator-(const Changing &a, const Changing &b) {
  return {a.value - b.value, a.change - b.change};
}
INLINE Changing operator-(double a, const Changing &b) { return {a - b.value, -b.change}; }
INLINE Changing operator/(double a, const Changing &b) {
  const double found = a / b.value;
  return {found, -found / b.value * b.change};
}
INLINE Changing root(const Changing &a) {
  const double found = root(a.value);
  return {found, 0.5 / most(found, 1e-12) * a.change};
}

INLINE HalfAngle<Changing> half_angle(const Changing &square) {
  if (square.value <= FAR) return half_angle_series<8>(square);
  const auto [cosine, sinc] = half_angle(square.value);
  return {{cosine, -0.5 * sinc * square.change},
          {sinc, 0.5 * (cosine - sinc) / square.value * square.change}};
}

// Amounts that change along shapes (N, columns), from 0 where null.
struct Along {
  const double *at, *shapes;
  size_t columns;

  Changing operator[](int64_t key) const {
    return {at ? at[key] : 0.0, load(shapes + key * columns)};
  }
};

// Where changes of moments go (N, columns).
struct Slopes {
  double *first;
  size_t columns;
};

INLINE void add(const Slopes &to, int64_t key, const Changing &moment) {
  double *row = to.first + key * to.columns;
  store(row, load(row) + moment.change);
}

void load_slopes(const sway_branches &tree, const double *x, const double *wind,
                 const double *shapes, size_t columns, double *scratch, double *turning,
                 double *damping) {
  auto *turned = reinterpret_cast<Load<Changing, Changing> *>(scratch);
  auto *loads = reinterpret_cast<Load<double, Changing> *>(scratch);
  static_assert(sizeof(*turned) <= 333 * sizeof(double), "sway_load_slopes");
  const size_t bytes = keys_of(tree) * columns * sizeof(double);
  memset(turning, 0, bytes);
  memset(damping, 0, bytes);
  const Vector<Changing> air = {{wind[0], {}}, {wind[1], {}}, {wind[2], {}}};
  for (size_t i = 0; i < columns; i += LANES) {
    const Along moving = {x, shapes + i, columns}, rates = {nullptr, shapes + i, columns};
    const Along *still = nullptr;
    add_moments(tree, moving, still, tree.load_mode, air, turned, Slopes{turning + i, columns});
    add_moments(tree, x, &rates, tree.load_mode, read(wind), loads, Slopes{damping + i, columns});
    for (int64_t b = 0; b < tree.branches; b++)
      for (int64_t c = 0; c < 2 && c < tree.n_coordinates[b]; c++) {
        const int64_t row = 3 * (tree.keys * b + c), key = tree.coordinate[b] + c;
        const Vector<double> at = read(tree.load_mode + row);
        const Vector<double> beyond = read(tree.damping_mode + row) - at;
        Vector<Changing> flow = loads[b].flow;
        flow.x.change = all(beyond.x);
        flow.y.change = all(beyond.y);
        flow.z.change = all(beyond.z);
        const Changing excess = dot(at, drag_of(tree, b, flow, Changing{}));
        const Vec rate = load(shapes + i + key * columns);
        add(Slopes{damping + i, columns}, key, {0.0, -most(excess.change, Vec{}) * rate});
      }
  }
}

}  // namespace
