# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Kinds of trees to judge models by, none made by the generator of the package.

A model is flattered by the trees it was made with. These hang, lean, have many limbs on one stem
or many stems on one foot.

"""
