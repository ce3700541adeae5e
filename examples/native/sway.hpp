// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// A tree that sways in C++: a .sway file and wind in, poses out, in the axes of sway.h.
#pragma once

#include <fstream>
#include <iterator>
#include <string.h>
#include <string>
#include <vector>

#include "sway.h"

namespace sway {

class Tree {
public:
  Tree() = default;
  Tree(const Tree &) = delete;
  Tree &operator=(const Tree &) = delete;
  ~Tree() {
    if (stand) sway_stand_close(stand);
    if (model) sway_model_close(model);
  }

  // Read a file, once; if this is false, `error` says why.
  bool open(const std::string &path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) return error = path + ": cannot be opened", false;
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    char why[300] = "";
    model = sway_model_open(bytes.data(), bytes.size(), why, sizeof why);
    const sway_tree tree = {0, {0.0, 0.0, 0.0}, 0.0, 1.0, 1.0};
    if (model) stand = sway_stand_open(&model, 1, &tree, 1, 1, why, sizeof why);
    error = path + ": " + why;
    if (!stand) return false;
    sway_sizes sizes;
    sway_model_sizes(model, &sizes);
    if (!sizes.is_stepped) return error = path + ": it can only be placed", false;
    poses.resize(7 * sizes.segments);
    place();
    const double *start = array(bytes, "tree_start"), *end = array(bytes, "tree_end");
    const double *base = array(bytes, "tree_base_diameter");
    const double *tip = array(bytes, "tree_tip_diameter");
    for (int64_t i = 0; i < sizes.segments; i++) {
      const double x = end[3 * i] - start[3 * i], y = end[3 * i + 1] - start[3 * i + 1];
      const double z = end[3 * i + 2] - start[3 * i + 2];
      lengths.push_back(__builtin_sqrt(x * x + y * y + z * z));
      diameters.push_back(0.5 * (base[i] + tip[i]));
    }
    return true;
  }

  // Go on by dt [s] in a wind [m/s], east, north, up; nothing moves unless dt is above 0.
  void step(double east, double north, double up, double dt) {
    if (!stand || sway_set_step(stand, dt) != 0) return;
    const double wind[] = {east, north, up};
    sway_step(stand, 0, 0, 1, wind, nullptr);
    place();
  }

  std::string error;
  std::vector<double> poses;               // (n, 7), see sway.h
  std::vector<double> lengths, diameters;  // of the segments (n) [m]

private:
  void place() {
    const int64_t rows[] = {0, 0};
    sway_place(stand, 0, rows, 1, poses.data());
  }

  // Numbers of a file that has been checked: entries of 72 bytes begin with a name and end with
  // the place of the numbers.
  static const double *array(const std::string &bytes, const char *name) {
    const char *entry = bytes.data() + 16;
    while (strncmp(entry, name, 24) != 0) entry += 72;
    uint64_t at;
    memcpy(&at, entry + 64, sizeof at);
    return reinterpret_cast<const double *>(bytes.data() + at);
  }

  sway_model *model = nullptr;
  sway_stand *stand = nullptr;
};

}  // namespace sway
