# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
#
# Critical winds by ForestGALES: the example stands that come with its R package fgr 0.0.0.9009.1.2
# (tom-locatelli/fgr at 0636e245), 1,000 trees of random size, and the stands of a page of 1997.
# Winds by its method for stands (of 1997: those of the page), then by its method for single trees.
# Species that tree_sway does not have are left out.
#
#   R CMD INSTALL fgr && Rscript forestgales.R > forestgales.csv

library(fgr)

ours <- c(SS = "sitka", NS = "spruce", SP = "pine", DF = "douglas_fir", BI = "birch", OK = "oak")

write_row <- function(source, species, height, dbh, spacing, gap = NA, given = list(), published = NULL) {
  if (!species %in% names(ours)) return()
  at_edge <- !is.na(gap)
  edge <- if (at_edge) list(gap_size = gap) else list()
  by_stand <- do.call(fg_rou, c(list(source, NA, species, height, dbh, spacing), given, edge,
                                if (at_edge) list(new_edge = 1)))
  by_tree <- do.call(fg_tmc, c(list(source, source, NA, species, height, dbh, spacing, species,
                                    height, dbh, height), given, edge, if (at_edge) list(dist_edge = 0)))
  if (is.null(published)) published <- c(by_stand$uh_b, by_stand$uh_o)
  cat(sprintf("%s,%s,%.2f,%.3f,%.2f,%s,%.2f,%.2f,%.2f,%.2f\n", source, ours[species], height,
              dbh / 100, spacing, if (at_edge) "edge" else "stand", published[1], published[2],
              by_tree$uh_b, by_tree$uh_o))
}

cat("source,species,height,diameter,spacing,exposure,breaks,overturns,tree_breaks,tree_overturns\n")
for (row in 1:6) {  # the seventh has wood and snow of its own
  stand <- df_rou[row, ]
  write_row("df_rou", as.character(stand$species), stand$mean_ht, stand$mean_dbh, stand$spacing)
}
rotation <- df_rou_mechanical[!duplicated(df_rou_mechanical[, c("mean_ht", "new_edge")]), ]
for (row in seq_len(nrow(rotation))) {
  stand <- rotation[row, ]
  given <- as.list(stand[c("soil_group", "rooting", "moe", "mor", "stem_density")])  # codespell:ignore mor
  gap <- if (stand$new_edge == 1) stand$gap_size else NA
  write_row("rotation", "SS", stand$mean_ht, stand$mean_dbh, stand$spacing, gap, given)
}
# Gardiner 1997, Sitka spruce of yield class 14 on podzol, unthinned and thinned:
# macaulay.webarchive.hutton.ac.uk/storms/private/thinktank/wind_opts_podzol.html
write_row("gardiner_1997", "SS", 10.3, 13, 1.96, published = c(13.5, 13.1))
write_row("gardiner_1997", "SS", 15.8, 18, 2.21, published = c(14.3, 15.0))
write_row("gardiner_1997", "SS", 20.5, 22, 2.54, published = c(14.3, 15.6))
write_row("gardiner_1997", "SS", 10.3, 14, 2.52, published = c(14.2, 13.2))
write_row("gardiner_1997", "SS", 15.8, 22, 3.53, published = c(14.2, 13.5))
write_row("gardiner_1997", "SS", 20.5, 29, 4.36, published = c(14.4, 13.7))
set.seed(1)
for (tree in 1:1000) {
  height <- round(runif(1, 10, 30), 2)
  dbh <- round(100 * height / runif(1, 55, 95), 1)
  write_row("sample", sample(c("SS", "NS", "SP", "DF"), 1), height, dbh, 0.18 * height)
}
