// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Rotation vectors in the law of loads: V is Vec, double, or a double with its changes.
#pragma once

#include "vec.h"

namespace {

template <class A, class B> INLINE auto operator-(const Vector<A> &a, const Vector<B> &b) {
  return Vector<decltype(a.x - b.x)>{a.x - b.x, a.y - b.y, a.z - b.z};
}

INLINE Vector<double> read(const double *from) { return {from[0], from[1], from[2]}; }

INLINE void write(double *to, const Vector<double> &v) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }

template <class A, class B> INLINE auto cross(const Vector<A> &a, const Vector<B> &b) {
  return Vector<decltype(a.x * b.x)>{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z,
                                     a.x * b.y - a.y * b.x};
}

// Rotate a vector by a rotation vector through Cayley's map, without root, sine or cosine. That map
// is always a rotation, by the angle 2 atan(|r| / 2). So the vector is stretched first, by the
// series of the tangent: the error of the angle is 1e-4 at 1 rad and 2 % at 2 rad. The opposite
// rotation vector inverts it to rounding.
template <class R, class V>
INLINE Vector<V> turned_by(const Vector<R> &rotation, const Vector<V> &v) {
  const R t = dot(rotation, rotation);
  const R half = 0.5 + t * (1.0 / 24.0 + t * (1.0 / 240.0 + t * (17.0 / 40320.0)));
  const Vector<R> h = half * rotation;
  const R f = 2.0 / (1.0 + dot(h, h));
  const Vector<V> c = cross(h, v);
  return v + f * (c + cross(h, c));
}

// The angular velocity of a rotation vector t that changes by w per second, by series:
// w + t x w / 2 + t x (t x w) / 6. By the opposite rotation vector it is transposed: what a couple w
// does per unit of t.
template <class R, class V>
INLINE Vector<V> spin_by(const Vector<R> &rotation, const Vector<V> &rate) {
  const Vector<V> first = cross(rotation, rate);
  return rate + 0.5 * first + (1.0 / 6.0) * cross(rotation, first);
}

// The unit quaternion of a rotation vector [rad].
template <class V> INLINE Quaternion<V> quaternion_of(const Vector<V> &rotation) {
  const Vector<V> half = 0.5 * rotation;
  return quaternion_of(half_angle(dot(half, half)), half);
}

// Three rows of a matrix.
struct Matrix {
  Vector<double> x, y, z;
};

INLINE Matrix read_matrix(const double *m) { return {read(m), read(m + 3), read(m + 6)}; }

// A matrix of numbers times a vector, and its transpose times a vector.
template <class V> INLINE Vector<V> operator*(const Matrix &m, const Vector<V> &v) {
  return {m.x.x * v.x + m.x.y * v.y + m.x.z * v.z, m.y.x * v.x + m.y.y * v.y + m.y.z * v.z,
          m.z.x * v.x + m.z.y * v.y + m.z.z * v.z};
}

template <class V> INLINE Vector<V> transposed_times(const Matrix &m, const Vector<V> &v) {
  return {m.x.x * v.x + m.y.x * v.y + m.z.x * v.z, m.x.y * v.x + m.y.y * v.y + m.z.y * v.z,
          m.x.z * v.x + m.y.z * v.y + m.z.z * v.z};
}

// A symmetric matrix xx yy zz xy xz yz times a vector.
template <class P, class V> INLINE Vector<V> times_symmetric(const P *p, const Vector<V> &u) {
  return {p[0] * u.x + p[3] * u.y + p[4] * u.z, p[3] * u.x + p[1] * u.y + p[5] * u.z,
          p[4] * u.x + p[5] * u.y + p[2] * u.z};
}

}  // namespace
