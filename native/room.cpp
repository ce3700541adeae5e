// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Memory of one thread.
#include "frame.h"

namespace {

using namespace sway;

void open_limp_room(Memory &memory, const Limp &limp, int64_t m, int64_t padded, LimpRoom &room) {
  memory.take(limp.keys, room.turned, room.turning, room.keys);
  memory.take(limp.places, room.here, room.ahead, room.behind, room.tangent, room.force, room.gust);
  memory.take((m + 2) * limp.row, room.products);
  memory.take(m + 2, room.rows);
  memory.take(limp.row, room.momentum, room.across, room.along);
  memory.take(limp.leading * limp.row, room.matrix, room.block);
  memory.take(8 * limp.row, room.coupled);
  memory.take(3 * limp.row, room.solved);
  memory.take(padded, room.eta, room.rate, room.new_force, room.by_wind, room.wanted, room.sloped);
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
  memory.take(keys + 64 + KEYS_BEYOND, room.keys);
  memory.take(8 * branches, room.bases);
  memory.take(7 * segments, room.poses[0]);
  if (PASSES_CACHES) memory.take(7 * segments, room.poses[1]);
  memory.take(slots_of(rows + 4), room.slots);
  memory.take(padded, room.middle, room.middle_rate, room.change);
  memory.take(padded, room.turned, room.damped, room.single_rate, room.shown);
  memory.take(4 * padded, room.distance);
  memory.take(16, room.single_keys);
  if (!ON_TABLES && limp.leading) open_limp_room(memory, limp, coordinates, padded, room.limp);
}

}  // namespace sway
