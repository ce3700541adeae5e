/* Copyright 2026 Tree Sway maintainers
 * SPDX-License-Identifier: Apache-2.0
 *
 * What the Python library calls beside sway.h. It is not part of the public interface: arrays are
 * not checked here, and functions may change with any version.
 *
 * Units are SI; arrays are in rows, (b, 3) is three numbers for each of b branches.
 */
#ifndef SWAY_LIBRARY_H
#define SWAY_LIBRARY_H

#include "sway.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The branches of a tree for the load of the wind on them, parents before their children. In the
 * frames of their bases at rest, which are that of the tree; k is the most key rotations that a
 * branch has. */
typedef struct sway_branches {
  int64_t branches;             /* b */
  int64_t keys;                 /* k */
  const int64_t *parent;        /* (b); below 0 for the stem, which is the first */
  const int64_t *coordinate;    /* first of its key rotations (b) */
  const int64_t *n_coordinates; /* how many it has, at most k (b) */
  const double *twist;          /* motion of its base per unit of its parent's (b, k, 6) */
  const double *base;           /* base [m] (b, 3) */
  const double *arm;            /* base from that of its parent [m] (b, 3) */
  const double *per_arm;        /* 0.5 over the square of its length [1/m^2] (b) */
  const double *speed;          /* wind at it over that of the tree (b) */
  const double *area;           /* drag area [m^2] (b) */
  const double *spread;         /* variance of the motion of its pieces [m^2] (b) */
  const double *projector;      /* mean of 1 - t t^T: xx yy zz xy xz yz (b, 6) */
  const double *coupling;       /* moment about its base per force [m] (b, 3, 3) */
  const double *load_mode;      /* motion that the force does work on (b, k, 3) */
  const double *damping_mode;   /* motion that the drag damps (b, k, 3) */
  const double *load_rotation;  /* rotation of its loaded pieces (b, k, 3) */
} sway_branches;

/* Motion of a branch and the load on it. */
typedef struct sway_branch_load {
  double velocity[6];     /* velocity and spin of the base in its own, turned frame */
  double orientation[4];  /* of the base from rest, w x y z */
  double rotation[3];     /* rotation vector of the base from that of its parent */
  double displacement[3]; /* of the base in the frame of its parent's [m] */
  double arm[3];          /* the base from that of its parent, bent [m] */
  double turn[3];         /* rotation vector of the loaded pieces from the base */
  double air[3];          /* wind in the frame of the base [m/s] */
  double own_force[3];    /* of the wind in the frame of the loaded pieces [N] */
  double force[3];        /* the same in the frame of the tree [N] */
  double wrench[6];       /* force and moment on the branch and all it carries, at its base */
} sway_branch_load;

/* Moments [N m] of uniform winds (count, 3) [m/s] on the key rotations of a tree in poses x
 * (count, N) [rad] that move at v (count, N) [rad/s], or are still if v is NULL; the drag density
 * is 1 kg/m^3. `loads` (b) is written, and is left as of the last pose; so is `moments`
 * (count, N). */
SWAY_API void sway_wind_moments(const sway_branches *tree, const double *x, const double *v,
                                const double *winds, size_t count, sway_branch_load *loads,
                                double *moments);

/* Changes of these moments by motion along shapes (N, columns), key rotations by their number:
 * `turning` by the motion, `damping` by its rate, (N, columns) each [N m]. `loads` (b) are those of
 * a still tree; `columns` is a multiple of 8; `scratch` has room for 256 numbers for each branch and
 * 8 more. */
SWAY_API void sway_load_slopes(const sway_branches *tree, const sway_branch_load *loads,
                               const double *shapes, size_t columns, double *scratch,
                               double *turning, double *damping);

#ifdef __cplusplus
}
#endif

#endif
