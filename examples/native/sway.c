/* Copyright 2026 Tree Sway maintainers
 * SPDX-License-Identifier: Apache-2.0
 *
 * A tree that sways in C: prints the start of its last segment in every frame of a gust.
 *
 *     tree-sway convert oak.yaml -o oak.sway
 *     cc sway.c -I native LIBRARY -o sway && ./sway oak.sway
 *
 * LIBRARY is what `python3 -c "from tree_sway.core.native.library import FILE; print(FILE)"` prints.
 */
#include <stdio.h>
#include <stdlib.h>

#include "sway.h"

int main(int argc, char **argv) {
  if (argc < 2) return fprintf(stderr, "give a .sway file\n"), 1;
  FILE *file = fopen(argv[1], "rb");
  if (!file) return perror(argv[1]), 1;
  fseek(file, 0, SEEK_END);
  const size_t size = (size_t)ftell(file);
  rewind(file);
  void *bytes = malloc(size);
  if (!bytes || fread(bytes, 1, size, file) != size) return 1;

  char error[300] = "";
  sway_model *model = sway_model_open(bytes, size, error, sizeof error);
  if (!model) return fprintf(stderr, "%s\n", error), 1;
  sway_sizes sizes;
  sway_model_sizes(model, &sizes);
  const sway_tree tree = {0, {0.0, 0.0, 0.0}, 0.0, 1.0, 1.0};
  const sway_model *models[] = {model};
  sway_stand *stand = sway_stand_open(models, 1, &tree, 1, 1, error, sizeof error);
  if (!stand) return fprintf(stderr, "%s\n", error), 1;

  double *poses = malloc((size_t)sizes.segments * 7 * sizeof(double));
  const int64_t rows[] = {0, 0};
  if (!poses || sway_set_step(stand, 1.0 / 60.0) != 0) return 1;
  for (int frame = 0; frame < 300; frame++) {
    const double wind[] = {frame < 120 ? 8.0 : 3.0, 1.0, 0.0};
    sway_step(stand, 0, 0, 1, wind, NULL);
    sway_place(stand, 0, rows, 1, poses);
    const double *last = poses + 7 * (sizes.segments - 1);
    printf("%.9f %.9f %.9f\n", last[0], last[1], last[2]);
  }
  sway_stand_close(stand);
  sway_model_close(model);
  free(poses);
  free(bytes);
  fclose(file);
  return 0;
}
