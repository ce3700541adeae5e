// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Memory of one thread.
#include "frame.h"

namespace {

using namespace sway;

void open_limp_room(Memory &memory, const Limp &limp, int64_t m, int64_t padded, LimpRoom &room) {
  double **keys[] = {&room.turned, &room.turning, &room.keys};
  for (double **each : keys) *each = memory.take<double>(limp.keys);
  double **places[] = {&room.here,    &room.ahead, &room.behind, &room.trial,
                       &room.tangent, &room.force, &room.gust};
  for (double **each : places) *each = memory.take<double>(limp.places);
  room.products = memory.take<double>((m + 2) * limp.row);
  room.rows = memory.take<const double *>(m + 2);
  double **rows[] = {&room.momentum, &room.across, &room.along};
  for (double **each : rows) *each = memory.take<double>(limp.row);
  room.matrix = memory.take<double>(limp.leading * limp.row);
  room.block = memory.take<double>(limp.leading * limp.row);
  room.coupled = memory.take<double>(8 * limp.row);
  room.solved = memory.take<double>(3 * limp.row);
  double **coordinates[] = {&room.eta,     &room.rate,   &room.new_force,
                            &room.by_wind, &room.wanted, &room.sloped};
  for (double **each : coordinates) *each = memory.take<double>(padded);
}

void raise_to(int64_t &largest, int64_t value) {
  if (value > largest) largest = value;
}

}  // namespace

namespace sway {

void open_room(Memory &memory, const sway_model *const *models, size_t n_models, Room &room) {
  int64_t keys = 0, branches = 0, segments = 0, rows = 0, padded = 0, coordinates = 0;
  Limp limp = {};
  for (size_t i = 0; i < n_models; i++) {
    const sway_model &model = *models[i];
    raise_to(keys, model.sizes.keys);
    raise_to(branches, model.sizes.branches);
    raise_to(segments, model.sizes.segments);
    raise_to(rows, model.rows);
    raise_to(padded, model.padded);
    if (ON_TABLES || !model.limp.leading) continue;
    raise_to(coordinates, model.sizes.coordinates);
    raise_to(limp.leading, model.limp.leading);
    raise_to(limp.row, model.limp.row);
    raise_to(limp.places, model.limp.places);
    raise_to(limp.keys, model.limp.keys);
  }
  room.keys = memory.take<double>(keys + 64 + KEYS_BEYOND);
  room.bases = memory.take<double>(8 * branches);
  room.poses = memory.take<double>(7 * segments);
  room.slots = memory.take<double>(slots_of(rows + 4));
  double **doubles[] = {&room.middle, &room.middle_rate, &room.change};
  for (double **each : doubles) *each = memory.take<double>(padded);
  float **singles[] = {&room.turned, &room.damped, &room.single_rate, &room.shown};
  for (float **each : singles) *each = memory.take<float>(padded);
  room.distance = memory.take<float>(4 * padded);
  room.single_keys = memory.take<float>(16);
  if (!ON_TABLES && limp.leading) open_limp_room(memory, limp, coordinates, padded, room.limp);
}

}  // namespace sway
