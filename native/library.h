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
 * a still tree; `columns` is a multiple of 8; `scratch` has room for 256 numbers for each branch
 * and 8 more. */
SWAY_API void sway_load_slopes(const sway_branches *tree, const sway_branch_load *loads,
                               const double *shapes, size_t columns, double *scratch,
                               double *turning, double *damping);

/* Sixteen branches of the model `branch`; a branch that is not there has zeros. */
typedef struct sway_branch_block {
  double speed[16];               /* wind at it over that of the tree */
  double area[16];                /* drag area [m^2] */
  double spread[16];              /* variance of the motion of its pieces [m^2] */
  double projector[6][16];        /* mean of 1 - t t^T: xx yy zz xy xz yz */
  double damping_mode[2][3][16];  /* by its key rotations: motion that the drag damps [m] */
  double load_rotation[2][3][16]; /* rotation of its loaded pieces */
  double load_mode[2][3][16];     /* motion that the force does work on [m] */
  double chord_lever[3][16];      /* direction of the chord times the lever of the load [m] */
  /* Set with the time step: */
  double compliance[16]; /* velocity half a step after a unit of force [s/kg] */
  double whole[8][16];   /* coefficients of the propagator of a step */
  double half[6][16];    /* of half a step under a constant load */
  double guard[3][16];   /* inertia of the gyroscopic term, limits of load and moment */
  /* Set with the wind: its wind less that of the tree [m/s] */
  double gust[3][16];
  /* State: */
  double drag_impulse[3][16]; /* change of the relative wind by the force, over compliance [N] */
  double load[3][16];         /* load along the chord and on its key rotations [N m] */
  double force[3][16];        /* of the wind [N] */
} sway_branch_block;

/* Step `count` branches in the wind x y z [m/s] of a drag density [kg/m^3], mean over the step:
 * key rotations [rad] and their rates [rad/s] (count, 2). Returns how many loads were clamped, or
 * -1 if the motion is no longer finite. */
SWAY_API int64_t sway_step_branches(sway_branch_block *blocks, size_t count, double *rotations,
                                    double *rates, double x, double y, double z,
                                    double drag_density);

/* The key rotations (count, 2) of branches of a stiffness [N m] (count) at rest in a wind, as near
 * as some turns come. The compliance of the blocks is 0. */
SWAY_API void sway_rest_branches(sway_branch_block *blocks, size_t count, double x, double y,
                                 double z, double drag_density, const double *stiffness,
                                 double *rotations);

#ifdef __cplusplus
}
#endif

#endif
