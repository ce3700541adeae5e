# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
# A tree that sways on ROS 2 Jazzy:
#     docker build -t tree-sway . && docker run --rm --net host tree-sway tree:=goldcrest
FROM ros:jazzy
SHELL ["/bin/bash", "-c"]
WORKDIR /ws
COPY . src/tree_sway_ros
# rviz2 and what tests need are left out; numba, which Ubuntu 24.04 has no package of, comes by pip.
RUN apt-get update && rosdep update \
 && rosdep install --from-paths src --ignore-src --default-yes --dependency-types exec --skip-keys rviz2 \
 && apt-get install --yes --no-install-recommends python3-pip \
 && pip install --break-system-packages --no-cache-dir "numba>=0.59" "numpy<2" \
 && source /opt/ros/jazzy/setup.bash && colcon build \
 && rm -rf /var/lib/apt/lists/* build log
# Kernels are compiled once, here, and not at each start.
ENV TREE_SWAY_CACHE=/ws/kernels
RUN source install/setup.bash && ros2 run tree_sway_ros tree-sway show goldcrest --seconds 1 --port 0
ENTRYPOINT ["/bin/bash", "-c", "source /ws/install/setup.bash && exec ros2 launch --noninteractive tree_sway_ros sway.launch.py \"$@\"", "--"]
