# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
# A tree that sways on ROS 2 Jazzy:
#     docker build -t tree-sway . && docker run --rm --net host tree-sway tree:=goldcrest
FROM ros:jazzy
SHELL ["/bin/bash", "-c"]
WORKDIR /ws
COPY . src/tree_sway_ros
# rviz2 and what tests need are left out.
RUN apt-get update && rosdep update \
 && rosdep install --from-paths src --ignore-src --default-yes --dependency-types exec --skip-keys rviz2 \
 && apt-get install --yes --no-install-recommends g++ \
 && source /opt/ros/jazzy/setup.bash && colcon build \
 && rm -rf /var/lib/apt/lists/* build log
ENTRYPOINT ["/bin/bash", "-c", "source /ws/install/setup.bash && exec ros2 launch --noninteractive tree_sway_ros sway.launch.py \"$@\"", "--"]
