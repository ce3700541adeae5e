// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// From the bytes of a model to its arrays, each checked once, and to the memory of a frame.
//
// Bytes: "SWAYTREE", the version and the number of arrays (two uint32), then for each array its
// name (24 characters, filled up with zeros), type (uint32: 0 double, 1 float, 2 int64), number of
// dimensions (uint32), sizes (4 uint64) and offset from the beginning (uint64, a multiple of 8);
// little-endian, in the order of C.
#include "model.h"

#include "gusts.h"
#include "limp_layout.h"
#include "place_layout.h"
#include "text.h"

namespace {

using namespace sway;

struct Entry {
  char name[24];
  uint32_t type, dimensions;
  uint64_t shape[4];
  uint64_t offset;
};

struct Header {
  char magic[8];
  uint32_t version, count;
};

enum Type { TYPE_double, TYPE_float, TYPE_int64_t };

struct Meaning {
  const char *name;
  Type type;
  Group group;
  int64_t shape[4];
};

constexpr size_t BYTES[] = {8, 4, 8};

const Meaning MEANINGS[] = {
#define SWAY_ARRAY(type, name, group, ...) {#name, TYPE_##type, group, {__VA_ARGS__}},
#include "arrays.inc"
#undef SWAY_ARRAY
};
constexpr int N_MEANINGS = sizeof(MEANINGS) / sizeof(*MEANINGS);

// No tree has a number of this magnitude, in SI, nor single precision a greater one.
constexpr double LARGEST = 1e38;

// Coordinates of whole vectors, of doubles and of singles, on every target of the machine.
#if defined(__wasm__)
constexpr int64_t WHOLE = 4;
#else
constexpr int64_t WHOLE = 16;
#endif

// Numbers of coordinates and key rotations beyond which a file is none of a tree.
constexpr int64_t MOST_COORDINATES = 1 << 16, MOST_SEGMENTS = 1 << 26;

int number_of(const char *name) {
  for (int number = 0; number < N_MEANINGS; number++) {
    const char *known = MEANINGS[number].name;
    size_t i = 0;
    while (name[i] && name[i] == known[i]) i++;
    if (name[i] == known[i]) return number;
  }
  return -1;
}

int64_t size_of(const Arrays &arrays, int64_t size) { return size < 0 ? arrays.size[-size] : size; }

// The first array of a group that is there or that is missing; -1 without.
int first_of(Arrays &arrays, Group group, bool is_there) {
  for (int number = 0; number < N_MEANINGS; number++)
    if (MEANINGS[number].group == group && (arrays[number] != nullptr) == is_there) return number;
  return -1;
}

bool has_table(Arrays &a) {
  return a.drag_law && a.most_pressure && a.most_energy && a.stiffness && a.own_damping &&
         first_of(a, TABLE, false) < 0;
}

// Whether there is nothing to be placed: the model of a receiver that solves a tree by its table.
bool is_table_alone(Arrays &a) {
  return first_of(a, TREE, true) < 0 && first_of(a, PLACING, true) < 0;
}

class Reader {
public:
  Reader(const char *bytes, size_t size, Arrays &arrays, Text &error)
      : bytes_(bytes), size_(size), arrays_(arrays), error_(error) {}

  // Find and check all arrays.
  bool read() {
    Header header;
    if (size_ < sizeof(Header)) return refuse("model", "no bytes of a model");
    memcpy(&header, bytes_, sizeof header);
    if (memcmp(header.magic, "SWAYTREE", 8) != 0) return refuse("model", "no bytes of a model");
    if (header.version != SWAY_VERSION)
      return refuse("model", "of another version; convert the tree again");
    if (header.count > (size_ - sizeof header) / sizeof(Entry))
      return refuse("model", "cut off in its list of arrays");
    for (uint32_t i = 0; i < header.count; i++)
      if (!read_entry(i)) return false;
    return find_sizes() && check_all() && check_indices();
  }

private:
  bool refuse(const char *name, const char *what) {
    error_.add("array '").add(name).add("': ").add(what);
    return false;
  }

  bool read_entry(uint32_t index) {
    Entry entry;
    memcpy(&entry, bytes_ + sizeof(Header) + index * sizeof(Entry), sizeof entry);
    entry.name[sizeof entry.name - 1] = '\0';
    const int number = number_of(entry.name);
    if (number < 0) return refuse(entry.name, "unknown");
    if (arrays_[number]) return refuse(entry.name, "twice");
    if (entry.type != MEANINGS[number].type) return refuse(entry.name, "of another type");
    if (entry.dimensions < 1 || entry.dimensions > 4) return refuse(entry.name, "no array");
    uint64_t count = 1;
    for (uint32_t axis = 0; axis < 4; axis++) {
      uint64_t &own = entry.shape[axis];
      if (axis >= entry.dimensions)
        own = 0;
      else if (own > size_ || (own != 0 && count > size_ / own))
        return refuse(entry.name, "cut off");
      else
        count *= own;
    }
    if (entry.offset % 8 != 0 || entry.offset > size_ ||
        count > (size_ - entry.offset) / BYTES[entry.type])
      return refuse(entry.name, "cut off");
    arrays_[number] = bytes_ + entry.offset;
    entries_[number] = entry;
    counts_[number] = count;
    return true;
  }

  int64_t length(const char *name, int axis = 0) const {
    return int64_t(entries_[number_of(name)].shape[axis]);
  }

  bool find_sizes() {
    int64_t *size = arrays_.size;
    size[-SIZE_n] = length("tree_start");
    size[-SIZE_b] = length("branch_parent");
    size[-SIZE_b_plus_1] = size[-SIZE_b] + 1;
    size[-SIZE_k] = length("branch_twist", 1);
    size[-SIZE_m] = length("stiffness");
    size[-SIZE_q] = length("inertia_slopes");
    size[-SIZE_s] = length("stream_scale");
    if (size[-SIZE_m] > MOST_COORDINATES) return refuse("stiffness", "too many coordinates");
    size[-SIZE_delays] = length("limb_share");
    if (is_table_alone(arrays_)) return true;
    if (!arrays_.branch_keys) return refuse("branch_keys", "missing");
    for (uint64_t i = 0; i < counts_[number_of("branch_keys")]; i++) {
      const int64_t own = arrays_.branch_keys[i];
      if (own < 2 || own > size[-SIZE_k])
        return refuse("branch_keys", "a number that no branch has");
      size[-SIZE_N] += own;
    }
    if (size[-SIZE_n] < 1 || size[-SIZE_n] > MOST_SEGMENTS) return refuse("tree_start", "no tree");
    if (size[-SIZE_k] < 2 || size[-SIZE_k] > 64) return refuse("branch_twist", "no tree");
    return true;
  }

  bool check_all() {
    for (int number = 0; number < N_MEANINGS; number++) {
      const Meaning &meaning = MEANINGS[number];
      if (!arrays_[number]) continue;
      for (uint32_t axis = 0; axis < 4; axis++) {
        const int64_t wanted = meaning.shape[axis];
        if ((axis < entries_[number].dimensions) != (wanted != 0))
          return refuse(meaning.name, "of another number of dimensions");
        const int64_t own = int64_t(entries_[number].shape[axis]);
        if (wanted != SIZE_any && own != size_of(arrays_, wanted))
          return refuse(meaning.name, "of another shape");
      }
      if (!is_plausible(number)) return refuse(meaning.name, "a number that no tree has");
    }
    return true;
  }

  bool is_plausible(int number) {
    const Type type = MEANINGS[number].type;
    const double *doubles = static_cast<const double *>(arrays_[number]);
    const float *singles = static_cast<const float *>(arrays_[number]);
    bool holds = true;
    for (uint64_t i = 0; i < counts_[number] && type != TYPE_int64_t; i++) {
      const double value = type == TYPE_double ? doubles[i] : double(singles[i]);
      holds &= value >= -LARGEST && value <= LARGEST;
    }
    return holds;
  }

  bool check_indices() {
    Arrays &a = arrays_;
    if (is_table_alone(a)) return has_table(a) || refuse("turning", "missing, and no tree");
    const int64_t n = a.size[-SIZE_n], b = a.size[-SIZE_b], N = a.size[-SIZE_N];
    const int of_tree = first_of(a, TREE, false), of_placing = first_of(a, PLACING, false);
    if (of_tree >= 0) return refuse(MEANINGS[of_tree].name, "missing");
    if (of_placing >= 0) return refuse(MEANINGS[of_placing].name, "missing");
    if (has_table(a) && !a.shapes) return refuse("shapes", "missing");
    if (b < 1 || b > n) return refuse("branch_parent", "no tree");
    if (a.branch_first[0] != 0 || a.branch_first[b] != n)
      return refuse("branch_first", "no rise from 0 to the number of segments");
    for (int64_t i = 0; i < b; i++) {
      const int64_t parent = a.branch_parent[i], seat = a.branch_base_segment[i];
      if (a.branch_first[i + 1] <= a.branch_first[i] || a.branch_first[i + 1] > n)
        return refuse("branch_first", "no rise from 0 to the number of segments");
      if (i == 0 ? parent != -1 : parent < 0 || parent >= i)
        return refuse("branch_parent", "not one stem with parents first");
      if (i == 0 ? seat != -1 : seat < a.branch_first[parent] || seat >= a.branch_first[parent + 1])
        return refuse("branch_base_segment", "no segment of the parent");
      if (a.branch_coordinate[i] < 0 || a.branch_coordinate[i] > N - a.branch_keys[i])
        return refuse("branch_coordinate", "a key rotation that does not exist");
      if (a.limb_delay && (a.limb_delay[i] < 0 || a.limb_delay[i] >= a.size[-SIZE_delays]))
        return refuse("limb_delay", "a delay that does not exist");
    }
    if (a.size[-SIZE_delays] > DELAYS) return refuse("limb_share", "more delays than there are");
    return true;
  }

  const char *bytes_;
  size_t size_;
  Arrays &arrays_;
  Text &error_;
  Entry entries_[N_MEANINGS] = {};
  uint64_t counts_[N_MEANINGS] = {};
};

// Copy the arrays of a group; rows of coordinates are filled up with zeros to whole vectors.
void lay_out_group(sway_model &model, Arrays &given, Group group) {
  for (int number = 0; number < N_MEANINGS; number++) {
    const Meaning &meaning = MEANINGS[number];
    const char *from = static_cast<const char *>(given[number]);
    if (meaning.group != group || !from) continue;
    const size_t bytes = BYTES[meaning.type];
    int64_t rows = 1, own = 1, padded = 1;
    for (int axis = 0; axis < 4 && meaning.shape[axis]; axis++) {
      rows *= own;
      own = size_of(given, meaning.shape[axis]);
      padded = meaning.shape[axis] == SIZE_m ? model.padded : own;
    }
    char *to;
    model.memory.take(rows * padded * bytes, to);
    for (int64_t row = 0; row < rows && to; row++)
      memcpy(to + row * padded * bytes, from + row * own * bytes, own * bytes);
    model.table[number] = to;
  }
}

// Shapes of 64 key rotations at a time, in single precision.
void lay_out_shapes(sway_model &model, const Arrays &a) {
  const int64_t N = model.sizes.keys, m = model.sizes.coordinates;
  model.memory.take((N + 63) / 64 * m * 64, model.shapes);
  for (int64_t key = 0; key < N && model.shapes; key++)
    for (int64_t i = 0; i < m; i++)
      model.shapes[(key / 64 * m + i) * 64 + key % 64] = float(a.shapes[key * m + i]);
}

void lay_out(sway_model &model, Arrays &a) {
  sway_sizes &sizes = model.sizes;
  sizes.segments = a.size[-SIZE_n];
  sizes.branches = a.size[-SIZE_b];
  sizes.keys = a.size[-SIZE_N];
  sizes.coordinates = a.shapes || has_table(a) ? a.size[-SIZE_m] : 0;
  const bool by_table = has_table(a), at_pose = has_pose(a);
  const bool has_limbs = by_table ? a.limb_harmonics != nullptr : a.limb_delay && at_pose;
  sizes.delays = has_limbs && a.limb_spread && a.crown_coherence ? a.size[-SIZE_delays] : 0;
  sizes.is_stepped = by_table;
  model.rows = a.size[-SIZE_k];
  model.padded = (sizes.coordinates + WHOLE - 1) / WHOLE * WHOLE;
  if (a.tree_start) lay_out_places(model, a);
  if (a.shapes) lay_out_shapes(model, a);
  if (!by_table && !at_pose) return;
  const int64_t m = sizes.coordinates;
  model.memory.take(model.padded, model.stiffness, model.own_damping);
  for (int64_t i = 0; i < model.padded && !model.memory.is_short; i++) {
    model.stiffness[i] = i < m ? a.stiffness[i] : 1.0;
    model.own_damping[i] = i < m ? a.own_damping[i] : 0.0;
  }
  lay_out_group(model, a, NUMBERS);
  if (by_table) lay_out_group(model, a, TABLE);
  if (sizes.delays) lay_out_group(model, a, LIMBS);
  if (sizes.delays) lay_out_group(model, a, LIMB_LOADS);
  if (!ON_TABLES && at_pose && lay_out_limp(model, a)) sizes.is_stepped = 2;
}

}  // namespace

extern "C" {

int sway_version(void) { return SWAY_VERSION; }

#if defined(SWAY_INTERFACE)
uint32_t sway_interface(void) { return SWAY_INTERFACE; }
#endif

sway_model *sway_model_open(const void *bytes, size_t size, char *error, size_t room) {
  Text text(error, room);
  Memory memory;
  // A copy at the beginning of a line, so that every array is aligned.
  char *own = nullptr;
  if (bytes) memory.take(size, own);
  Arrays arrays = {};
  sway_model *model = nullptr;
  if (own) memcpy(own, bytes, size);
  if (!bytes) {
    text.add("no bytes");
  } else if (!own) {
    text.add("memory is short");
  } else if (Reader(own, size, arrays, text).read()) {
    model = static_cast<sway_model *>(calloc(1, sizeof(sway_model)));
    if (model) lay_out(*model, arrays);
    if (!model || model->memory.is_short) {
      sway_model_close(model);
      model = nullptr;
      text.add("memory is short");
    }
  }
  memory.release();
  return model;
}

void sway_model_close(sway_model *model) {
  if (!model) return;
  model->memory.release();
  free(model);
}

void sway_model_sizes(const sway_model *model, sway_sizes *sizes) { *sizes = model->sizes; }
}
