// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Forces of a pull are written in N and, from a thousand on, in kN. */

import assert from "node:assert/strict";
import { test } from "node:test";

import { forceText } from "../../tree_sway/page/static/drag.js";

test("a force has three digits and a unit that people read", () => {
  assert.equal(forceText(0.01234), "0.0123 N");
  assert.equal(forceText(999.4), "999 N");
  assert.equal(forceText(999.7), "1 kN");
  assert.equal(forceText(233412), "233 kN");
});
