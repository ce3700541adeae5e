// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** The page's files for modules that run without a server; import it before them. */

import { readFileSync } from "node:fs";

const folder = new URL("../../tree_sway/page/static/", import.meta.url);
globalThis.treeSwayFiles = Object.fromEntries(
  ["species.json", "words.json", "drawing/props.json", "drawing/shaders.glsl"].map((name) =>
    [name, readFileSync(new URL(name, folder), "utf8")]));
