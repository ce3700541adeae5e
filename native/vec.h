// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Vectors of as many lanes as the target has, and rotations on them.
//
// Everything here has internal linkage: a function compiled for one target must never be linked
// into another.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "memory.h"

#if defined(__AVX512F__)
#include <immintrin.h>
#define SWAY_LANES 8
#elif defined(__AVX2__)
#include <immintrin.h>
#define SWAY_LANES 4
#else
#define SWAY_LANES 2
#endif

namespace {

constexpr int LANES = SWAY_LANES;

constexpr double DEGREE = 3.14159265358979323846 / 180.0;

typedef double Vec __attribute__((vector_size(8 * LANES)));
typedef float Singles __attribute__((vector_size(8 * LANES)));      // 2 LANES numbers
typedef float HalfSingles __attribute__((vector_size(4 * LANES)));  // LANES numbers
typedef int64_t Mask __attribute__((vector_size(8 * LANES)));
typedef double Four __attribute__((vector_size(32)));

// The same in memory of any alignment.
typedef double VecAt __attribute__((vector_size(8 * LANES), aligned(8), may_alias));
typedef float SinglesAt __attribute__((vector_size(8 * LANES), aligned(4), may_alias));
typedef float HalfSinglesAt __attribute__((vector_size(4 * LANES), aligned(4), may_alias));
typedef double FourAt __attribute__((vector_size(32), aligned(8), may_alias));

INLINE Vec load(const double *from) { return *reinterpret_cast<const VecAt *>(from); }
INLINE void store(double *to, Vec value) { *reinterpret_cast<VecAt *>(to) = value; }
INLINE Singles load(const float *from) { return *reinterpret_cast<const SinglesAt *>(from); }
INLINE void store(float *to, Singles value) { *reinterpret_cast<SinglesAt *>(to) = value; }

INLINE Vec load_singles(const float *from) {
  const HalfSingles singles = *reinterpret_cast<const HalfSinglesAt *>(from);
#if defined(__AVX512F__)
  // GCC 12 to 14 convert the two halves one after the other.
  return reinterpret_cast<Vec>(_mm512_maskz_cvtps_pd(0xff, reinterpret_cast<__m256>(singles)));
#else
  return __builtin_convertvector(singles, Vec);
#endif
}

INLINE Vec all(double value) { return value - Vec{}; }

INLINE Vec least(Vec a, Vec b) { return a < b ? a : b; }
INLINE Vec most(Vec a, Vec b) { return a > b ? a : b; }
INLINE double least(double a, double b) { return a < b ? a : b; }
INLINE double most(double a, double b) { return a > b ? a : b; }

INLINE Vec root(Vec value) {
#if defined(__AVX512F__)
  return reinterpret_cast<Vec>(_mm512_maskz_sqrt_pd(0xff, reinterpret_cast<__m512d>(value)));
#elif defined(__AVX2__)
  return reinterpret_cast<Vec>(_mm256_sqrt_pd(reinterpret_cast<__m256d>(value)));
#else
  for (int lane = 0; lane < LANES; lane++) value[lane] = __builtin_sqrt(value[lane]);
  return value;
#endif
}

INLINE double sum(Vec value) {
  double total = 0.0;
  for (int lane = 0; lane < LANES; lane++) total += value[lane];
  return total;
}

INLINE double largest(Vec value) {
  double found = value[0];
  for (int lane = 1; lane < LANES; lane++) found = most(found, value[lane]);
  return found;
}

// Transpose four rows of four numbers.
INLINE void transpose(Four &a, Four &b, Four &c, Four &d) {
  const Four ab_even = __builtin_shufflevector(a, b, 0, 4, 2, 6);
  const Four ab_odd = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Four cd_even = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const Four cd_odd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5);
  c = __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7);
  d = __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7);
}

INLINE Four load_four(const double *from) { return *reinterpret_cast<const FourAt *>(from); }
INLINE void store_four(double *to, Four value) { *reinterpret_cast<FourAt *>(to) = value; }

// Numbers of lanes, V is Vec or double.

template <class V> struct Vector {
  V x, y, z;
};

template <class V> struct Quaternion {
  V w, x, y, z;
};

// Values of sixteen branches, a slot each.
typedef double Row[16];

INLINE Vector<Vec> load_vector(const Row *rows, int slot) {
  return {load(rows[0] + slot), load(rows[1] + slot), load(rows[2] + slot)};
}

INLINE void store_vector(Row *rows, int slot, const Vector<Vec> &v) {
  store(rows[0] + slot, v.x);
  store(rows[1] + slot, v.y);
  store(rows[2] + slot, v.z);
}

// b, then a.
template <class V> INLINE Quaternion<V> product(const Quaternion<V> &a, const Quaternion<V> &b) {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

// A quaternion times a vector, a quaternion without real part.
template <class V> INLINE Quaternion<V> product(const Quaternion<V> &a, const Vector<V> &b) {
  return {-a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x};
}

template <class V> INLINE Vector<V> rotated(const Quaternion<V> &q, const Vector<V> &v) {
  const V x = 2.0 * (q.y * v.z - q.z * v.y);
  const V y = 2.0 * (q.z * v.x - q.x * v.z);
  const V z = 2.0 * (q.x * v.y - q.y * v.x);
  return {v.x + q.w * x + q.y * z - q.z * y, v.y + q.w * y + q.z * x - q.x * z,
          v.z + q.w * z + q.x * y - q.y * x};
}

// The direction of the x axis of an orientation.
template <class V> INLINE Vector<V> axis(const Quaternion<V> &q) {
  return {1.0 - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y + q.w * q.z),
          2.0 * (q.x * q.z - q.w * q.y)};
}

template <class V> INLINE Vector<V> operator+(const Vector<V> &a, const Vector<V> &b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

template <class V> INLINE void operator+=(Vector<V> &a, const Vector<V> &b) { a = a + b; }

template <class V, class S> INLINE auto operator*(const S &scale, const Vector<V> &a) {
  return Vector<decltype(scale * a.x)>{scale * a.x, scale * a.y, scale * a.z};
}

template <class A, class B> INLINE auto dot(const Vector<A> &a, const Vector<B> &b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

// Cosine of half an angle, and its sine over the half angle.
template <class V> struct HalfAngle {
  V cosine, sinc;
};

// The quaternion of the halves of an angle and of its rotation vector.
template <class V>
INLINE Quaternion<V> quaternion_of(const HalfAngle<V> &by, const Vector<V> &half) {
  return {by.cosine, by.sinc * half.x, by.sinc * half.y, by.sinc * half.z};
}

// The largest squared half angles [rad^2] of the short and the long series: 0.2 and 1.5 rad.
constexpr double NEAR = 0.04, FAR = 2.25;

// Coefficients of the series of cos(sqrt t) and sin(sqrt t) / sqrt t.
struct Coefficients {
  double cosine[9] = {}, sinc[9] = {};

  constexpr Coefficients() {
    double factor = 1.0;
    for (int term = 0; term < 9; term++) {
      cosine[term] = 1.0 / factor;
      factor *= 2 * term + 1;
      sinc[term] = 1.0 / factor;
      factor *= -(2 * term + 2);
    }
  }
};

constexpr Coefficients BY = {};

// The error is below 3e-14 up to NEAR with 4 terms and below 3e-13 up to FAR with 8.
template <int TERMS, class V> INLINE HalfAngle<V> half_angle_series(V square) {
  V cosine = BY.cosine[TERMS] * square + BY.cosine[TERMS - 1];
  V sinc = BY.sinc[TERMS] * square + BY.sinc[TERMS - 1];
  for (int term = TERMS - 2; term >= 0; term--) {
    cosine = cosine * square + BY.cosine[term];
    sinc = sinc * square + BY.sinc[term];
  }
  return {cosine, sinc};
}

INLINE HalfAngle<double> half_angle(double square) {
  if (square <= FAR) return half_angle_series<8>(square);
  const double angle = __builtin_sqrt(square);
  return {__builtin_cos(angle), __builtin_sin(angle) / angle};
}

// The half angles of all lanes, whose squares are at most `bound`: of a part of a large one, doubled.
INLINE HalfAngle<Vec> half_angle(Vec square, double bound) {
  if (bound <= NEAR) return half_angle_series<4>(square);
  int doubled = 0;
  for (; bound > FAR && doubled < 512; doubled++, bound *= 0.25) square *= 0.25;
  HalfAngle<Vec> found = half_angle_series<8>(square);
  for (; doubled > 0; doubled--)
    found = {2.0 * found.cosine * found.cosine - 1.0, found.cosine * found.sinc};
  return found;
}

}  // namespace
