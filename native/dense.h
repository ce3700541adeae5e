// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Products and solutions of small dense matrices. Rows are filled up with zeros to whole multiples
// of sixteen numbers, and counts are of these.
#pragma once

#include "vec.h"

namespace {

// The sum of the lanes, in pairs.
INLINE double total(Vec value) {
  for (int apart = LANES / 2; apart > 0; apart /= 2)
    for (int lane = 0; lane < apart; lane++) value[lane] += value[lane + apart];
  return value[0];
}

// Products of some rows and some others from a number on; each number that is read serves several.
template <int ROWS, int OTHERS>
INLINE void block_products(const double *const *rows, const double *others, int64_t stride,
                           int64_t first, int64_t end, double *out, int64_t out_stride) {
  Vec sums[ROWS][OTHERS] = {};
  for (int64_t i = first; i < end; i += LANES)
    for (int other = 0; other < OTHERS; other++) {
      const Vec value = load(others + other * stride + i);
      for (int row = 0; row < ROWS; row++) sums[row][other] += load(rows[row] + i) * value;
    }
  for (int row = 0; row < ROWS; row++)
    for (int other = 0; other < OTHERS; other++) {
      double &to = out[row * out_stride + other];
      to = total(sums[row][other]) + (first ? to : 0.0);
    }
}

template <int ROWS, int OTHERS>
INLINE void row_products(const double *const *rows, int64_t n_rows, const double *others,
                         int64_t stride, int64_t first, int64_t end, double *out,
                         int64_t out_stride) {
  for (; n_rows >= ROWS; n_rows -= ROWS, rows += ROWS, out += ROWS * out_stride)
    block_products<ROWS, OTHERS>(rows, others, stride, first, end, out, out_stride);
  if constexpr (ROWS > 1)
    row_products<ROWS - 1, OTHERS>(rows, n_rows, others, stride, first, end, out, out_stride);
}

// Write the scalar product of each row and each of `n_others` rows of a matrix.
void multiply_rows(const double *const *rows, int64_t n_rows, const double *others,
                   int64_t n_others, int64_t stride, int64_t count, double *out,
                   int64_t out_stride) {
  constexpr int TOGETHER = LANES < 8 ? 2 : 4;  // as many as there are registers for
  // Of so many numbers all rows stay in the nearest cache.
  constexpr int64_t NEAREST = 512;
  for (int64_t first = 0; first < count; first += NEAREST) {
    const int64_t end = first + NEAREST < count ? first + NEAREST : count;
    int64_t other = 0;
    for (; other + TOGETHER <= n_others; other += TOGETHER)
      row_products<5, TOGETHER>(rows, n_rows, others + other * stride, stride, first, end,
                                out + other, out_stride);
    for (; other < n_others; other++)
      row_products<5, 1>(rows, n_rows, others + other * stride, stride, first, end, out + other,
                         out_stride);
  }
}

// Write the product of a matrix of `n_rows` rows and a vector.
INLINE void multiply(const double *matrix, int64_t n_rows, int64_t stride, const double *vector,
                     int64_t count, double *out) {
  multiply_rows(&vector, 1, matrix, n_rows, stride, count, out, 0);
}

INLINE double dot(const double *a, const double *b, int64_t count) {
  double product;
  block_products<1, 1>(&a, b, 0, 0, count, &product, 0);
  return product;
}

// The largest magnitude.
INLINE double largest(const double *values, int64_t count) {
  Vec found = {};
  for (int64_t i = 0; i < count; i += LANES) {
    const Vec value = load(values + i);
    found = most(found, most(value, -value));
  }
  return largest(found);
}

// Subtract from row i of a matrix what `ROWS` eliminated rows from the first on have of it.
template <int ROWS>
INLINE void eliminate(double *matrix, int64_t stride, int64_t first, int64_t i) {
  double *row = matrix + i * stride;
  const double *by = matrix + first * stride;
  for (int64_t j = i / LANES * LANES; j < stride; j += LANES) {
    Vec value = load(row + j);
    for (int k = 0; k < ROWS; k++) value -= by[k * stride + i] * load(by + k * stride + j);
    store(row + j, value);
  }
}

// Solve n equations for `n_rights` right-hand sides, by Cholesky's decomposition U' U. Rows of the
// matrix (n, stride), of which the upper half is read, end in the right-hand sides; rows of
// `solved` (n_rights, stride) are zero at first; `inverse` (n) is scratch memory. Returns whether
// the matrix was positive definite.
bool solve_positive(double *matrix, int64_t n, int64_t stride, int64_t n_rights, double *inverse,
                    double *solved) {
  constexpr int64_t TOGETHER = 4;
  for (int64_t first = 0; first < n; first += TOGETHER) {
    const int64_t end = first + TOGETHER < n ? first + TOGETHER : n;
    for (int64_t k = first; k < end; k++) {
      for (int64_t before = first; before < k; before++) eliminate<1>(matrix, stride, before, k);
      double *row = matrix + k * stride;
      if (!(row[k] > 0.0)) return false;
      inverse[k] = 1.0 / __builtin_sqrt(row[k]);
      for (int64_t j = k / LANES * LANES; j < stride; j += LANES)
        store(row + j, inverse[k] * load(row + j));
    }
    for (int64_t i = end; i < n; i++) eliminate<TOGETHER>(matrix, stride, first, i);
  }
  for (int64_t right = 0; right < n_rights; right++) {
    double *out = solved + right * stride;
    for (int64_t k = n - 1; k >= 0; k--) {
      const double *row = matrix + k * stride;
      Vec known = {};
      for (int64_t j = k / LANES * LANES; j < n; j += LANES) known += load(row + j) * load(out + j);
      out[k] = inverse[k] * (row[n + right] - total(known));
    }
  }
  return true;
}

}  // namespace
