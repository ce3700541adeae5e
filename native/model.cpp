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

struct Meaning {
  const char *name;
  uint32_t type;
  Group group;
  int64_t shape[4];
};

template <class T> struct TypeNumber;
template <> struct TypeNumber<double> {
  static constexpr uint32_t value = 0;
};
template <> struct TypeNumber<float> {
  static constexpr uint32_t value = 1;
};
template <> struct TypeNumber<int64_t> {
  static constexpr uint32_t value = 2;
};

constexpr size_t BYTES[] = {8, 4, 8};

const Meaning MEANINGS[] = {
#define SWAY_ARRAY(type, name, group, ...) {#name, TypeNumber<type>::value, group, {__VA_ARGS__}},
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
  for (int number = 0; number < N_MEANINGS; number++)
    if (strncmp(MEANINGS[number].name, name, sizeof(Entry::name)) == 0) return number;
  return -1;
}

bool has_table(const Arrays &a) {
  return a.drag_law && a.most_pressure && a.most_energy && a.stiffness && a.own_damping &&
         a.levels && a.limit && a.motion && a.harmonics && a.amount && a.equilibrium && a.load &&
         a.cross_damping && a.turning && a.damping && a.lean && a.steep_turning && a.steep_damping;
}

class Reader {
public:
  Reader(const char *bytes, size_t size, Text &error) : bytes_(bytes), size_(size), error_(error) {}

  // Find and check all arrays.
  bool read(Arrays &arrays) {
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
    if (!find_sizes(arrays)) return false;
    return check_all(arrays) && check_indices(arrays);
  }

private:
  struct Found {
    const char *data;
    uint32_t dimensions;
    uint64_t shape[4];
    uint64_t count;
  };

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
    const Meaning &meaning = MEANINGS[number];
    Found &found = found_[number];
    if (found.data) return refuse(meaning.name, "twice");
    if (entry.type != meaning.type) return refuse(meaning.name, "of another type");
    if (entry.dimensions < 1 || entry.dimensions > 4) return refuse(meaning.name, "no array");
    found.count = 1;
    found.dimensions = entry.dimensions;
    for (uint32_t axis = 0; axis < 4; axis++) {
      const uint64_t own = axis < entry.dimensions ? entry.shape[axis] : 0;
      found.shape[axis] = own;
      if (axis >= entry.dimensions) continue;
      if (own > size_) return refuse(meaning.name, "cut off");
      if (own != 0 && found.count > size_ / own) return refuse(meaning.name, "cut off");
      found.count *= own;
    }
    if (entry.offset % 8 != 0 || entry.offset > size_ ||
        found.count > (size_ - entry.offset) / BYTES[entry.type])
      return refuse(meaning.name, "cut off");
    found.data = bytes_ + entry.offset;
    return true;
  }

  int64_t length(const char *name, int axis = 0) const {
    const Found &found = found_[number_of(name)];
    return found.data ? static_cast<int64_t>(found.shape[axis]) : 0;
  }

  bool find_sizes(Arrays &arrays) {
    int64_t *size = arrays.size;
    memset(size, 0, sizeof arrays.size);
    size[-SIZE_n] = length("tree_start");
    size[-SIZE_b] = length("branch_parent");
    size[-SIZE_b_plus_1] = size[-SIZE_b] + 1;
    size[-SIZE_k] = length("branch_twist", 1);
    size[-SIZE_m] = length("stiffness");
    size[-SIZE_q] = length("inertia_slopes");
    size[-SIZE_s] = length("stream_scale");
    if (size[-SIZE_m] > MOST_COORDINATES) return refuse("stiffness", "too many coordinates");
    size[-SIZE_delays] = length("limb_share");
    if (is_table_alone()) return true;
    const Found &keys = found_[number_of("branch_keys")];
    if (!keys.data) return refuse("branch_keys", "missing");
    const int64_t *each = reinterpret_cast<const int64_t *>(keys.data);
    for (uint64_t i = 0; i < keys.count; i++) {
      if (each[i] < 2 || each[i] > size[-SIZE_k])
        return refuse("branch_keys", "a number that no branch has");
      size[-SIZE_N] += each[i];
    }
    if (size[-SIZE_n] < 1 || size[-SIZE_n] > MOST_SEGMENTS) return refuse("tree_start", "no tree");
    if (size[-SIZE_k] < 2 || size[-SIZE_k] > 64) return refuse("branch_twist", "no tree");
    return true;
  }

  // Whether there is nothing to be placed: the model of a receiver that solves a tree by its table.
  bool is_table_alone() const {
    for (int number = 0; number < N_MEANINGS; number++)
      if (found_[number].data &&
          (MEANINGS[number].group == TREE || MEANINGS[number].group == PLACING))
        return false;
    return true;
  }

  bool check_all(Arrays &arrays) {
    const void **pointers = reinterpret_cast<const void **>(&arrays);
    for (int number = 0; number < N_MEANINGS; number++) {
      const Meaning &meaning = MEANINGS[number];
      const Found &found = found_[number];
      pointers[number] = found.data;
      if (!found.data) continue;
      for (uint32_t axis = 0; axis < 4; axis++) {
        const int64_t wanted = meaning.shape[axis];
        if (axis >= found.dimensions ? wanted != 0 : wanted == 0)
          return refuse(meaning.name, "of another number of dimensions");
        const int64_t own = static_cast<int64_t>(found.shape[axis]);
        if (wanted > 0 && own != wanted) return refuse(meaning.name, "of another shape");
        if (wanted < 0 && wanted != SIZE_any && own != arrays.size[-wanted])
          return refuse(meaning.name, "of another shape");
      }
      if (!is_plausible(meaning, found)) return refuse(meaning.name, "a number that no tree has");
    }
    return true;
  }

  static bool is_plausible(const Meaning &meaning, const Found &found) {
    const double *doubles = reinterpret_cast<const double *>(found.data);
    const float *singles = reinterpret_cast<const float *>(found.data);
    bool holds = true;
    for (uint64_t i = 0; i < found.count && meaning.type != 2; i++) {
      const double value = meaning.type == 0 ? doubles[i] : static_cast<double>(singles[i]);
      holds &= value >= -LARGEST && value <= LARGEST;
    }
    return holds;
  }

  bool check_indices(const Arrays &a) {
    if (is_table_alone()) return has_table(a) || refuse("turning", "missing, and no tree");
    const int64_t n = a.size[-SIZE_n], b = a.size[-SIZE_b], N = a.size[-SIZE_N];
    for (int number = 0; number < N_MEANINGS; number++) {
      const Group group = MEANINGS[number].group;
      if ((group == TREE || group == PLACING) && !found_[number].data)
        return refuse(MEANINGS[number].name, "missing");
    }
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
    }
    if (a.size[-SIZE_delays] > DELAYS) return refuse("limb_share", "more delays than there are");
    if (a.limb_delay)
      for (int64_t i = 0; i < b; i++)
        if (a.limb_delay[i] < 0 || a.limb_delay[i] >= a.size[-SIZE_delays])
          return refuse("limb_delay", "a delay that does not exist");
    return true;
  }

  const char *bytes_;
  size_t size_;
  Text &error_;
  Found found_[N_MEANINGS] = {};
};

// Rows of coordinates, filled up with zeros to whole vectors.
template <class T>
const T *padded_rows(Memory &memory, const T *from, int64_t rows, int64_t m, int64_t padded) {
  T *rows_out = memory.take<T>(rows * padded);
  if (!rows_out || !from) return nullptr;
  for (int64_t row = 0; row < rows; row++)
    memcpy(rows_out + row * padded, from + row * m, m * sizeof(T));
  return rows_out;
}

void lay_out_table(sway_model &model, const Arrays &a) {
  Memory &memory = model.memory;
  const int64_t m = model.sizes.coordinates, M = model.padded;
  const int64_t corners = AZIMUTHS * LEVELS;
  WindTable &table = model.table;
  table.levels = padded_rows(memory, a.levels, AZIMUTHS, LEVELS, LEVELS);
  table.limit = padded_rows(memory, a.limit, 1, m, M);
  table.motion = padded_rows(memory, a.motion, 1, m, M);
  table.harmonics = padded_rows(memory, a.harmonics, HARMONICS, m, M);
  table.amount = padded_rows(memory, a.amount, AZIMUTHS, m, M);
  table.equilibrium = padded_rows(memory, a.equilibrium, corners, m, M);
  table.load = padded_rows(memory, a.load, corners, m, M);
  table.cross_damping = padded_rows(memory, a.cross_damping, corners, m, M);
  table.turning = padded_rows(memory, a.turning, corners * m, m, M);
  table.damping = padded_rows(memory, a.damping, corners * m, m, M);
  table.lean = padded_rows(memory, a.lean, AZIMUTHS * m, m, M);
  table.steep_turning = padded_rows(memory, a.steep_turning, 2 * m, m, M);
  table.steep_damping = padded_rows(memory, a.steep_damping, 2 * m, m, M);
  table.most_pressure = *a.most_pressure;
  table.most_energy = *a.most_energy;
}

// Shapes of 64 key rotations at a time, in single precision.
void lay_out_shapes(sway_model &model, const Arrays &a) {
  const int64_t N = model.sizes.keys, m = model.sizes.coordinates;
  float *shapes = model.memory.take<float>((N + 63) / 64 * m * 64);
  model.shapes = shapes;
  for (int64_t key = 0; key < N && shapes; key++)
    for (int64_t i = 0; i < m; i++)
      shapes[(key / 64 * m + i) * 64 + key % 64] = static_cast<float>(a.shapes[key * m + i]);
}

void lay_out(sway_model &model, const Arrays &a) {
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
  for (int axis = 0; axis < 3; axis++) model.drag_law[axis] = a.drag_law ? a.drag_law[axis] : 0.0;
  if (a.tree_start) lay_out_places(model, a);
  if (a.shapes) lay_out_shapes(model, a);
  if (!by_table && !at_pose) return;
  const int64_t m = sizes.coordinates;
  double *stiffness = model.memory.take<double>(model.padded);
  double *damping = model.memory.take<double>(model.padded);
  if (stiffness && damping)
    for (int64_t i = 0; i < model.padded; i++) {
      stiffness[i] = i < m ? a.stiffness[i] : 1.0;
      damping[i] = i < m ? a.own_damping[i] : 0.0;
    }
  model.stiffness = stiffness;
  model.own_damping = damping;
  if (by_table) lay_out_table(model, a);
  if (sizes.delays) {
    model.limb_share = padded_rows(model.memory, a.limb_share, 1, sizes.delays, sizes.delays);
    model.limb_harmonics =
        padded_rows(model.memory, a.limb_harmonics, sizes.delays * HARMONICS, m, model.padded);
    model.limb_spread = *a.limb_spread;
    model.crown_coherence = *a.crown_coherence;
  }
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
  char *own = bytes ? memory.take<char>(size) : nullptr;
  sway_model *model = nullptr;
  if (own) {
    memcpy(own, bytes, size);
    Arrays arrays;
    Reader reader(own, size, text);
    if (reader.read(arrays)) {
      model = static_cast<sway_model *>(calloc(1, sizeof(sway_model)));
      if (model) lay_out(*model, arrays);
      if (model && model->memory.is_short) {
        sway_model_close(model);
        model = nullptr;
      }
      if (!model) text.add("memory is short");
    }
  } else {
    text.add(bytes ? "memory is short" : "no bytes");
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
