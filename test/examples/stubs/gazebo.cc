// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// What the example takes from gz-sim 8 and its libraries, and a program that runs it. No Gazebo is
// here.
#include <chrono>
#include <iostream>
#include <memory>
#include <stdint.h>
#include <stdio.h>
#include <string>
#include <vector>

#define gzerr std::cerr
#define GZ_PI_2 1.5707963267948966
#define GZ_ADD_PLUGIN(...)

namespace gz::math {

struct Vector3d {
  double x = 0.0, y = 0.0, z = 0.0;
  double X() const { return x; }
  double Y() const { return y; }
  double Z() const { return z; }
};

struct Quaterniond {
  double w = 1.0, x = 0.0, y = 0.0, z = 0.0;
  Quaterniond operator*(const Quaterniond &q) const {
    return {w * q.w - x * q.x - y * q.y - z * q.z, w * q.x + x * q.w + y * q.z - z * q.y,
            w * q.y - x * q.z + y * q.w + z * q.x, w * q.z + x * q.y - y * q.x + z * q.w};
  }
  Vector3d RotateVector(const Vector3d &v) const {
    const Quaterniond back{w, -x, -y, -z};
    const Quaterniond turned = *this * Quaterniond{0.0, v.x, v.y, v.z} * back;
    return {turned.x, turned.y, turned.z};
  }
  Vector3d RotateVectorReverse(const Vector3d &v) const {
    return Quaterniond{w, -x, -y, -z}.RotateVector(v);
  }
};

struct Pose3d {
  Vector3d p;
  Quaterniond q;
  Pose3d() = default;
  Pose3d(const Vector3d &point, const Quaterniond &turn) : p(point), q(turn) {}
  Pose3d(double x, double y, double z, double w, double i, double j, double k)
      : p{x, y, z}, q{w, i, j, k} {}
  Pose3d(double x, double y, double z, double, double pitch, double)
      : p{x, y, z}, q{__builtin_cos(pitch / 2), 0.0, __builtin_sin(pitch / 2), 0.0} {}
  Quaterniond Rot() const { return q; }
  Vector3d Of(const Vector3d &v) const {
    const Vector3d turned = q.RotateVector(v);
    return {p.x + turned.x, p.y + turned.y, p.z + turned.z};
  }
  Pose3d operator*(const Pose3d &other) const { return {Of(other.p), q * other.q}; }
};

}  // namespace gz::math

namespace sdf {

struct Element {
  std::string tree;
  template <class T>
  T Get(const std::string &name) const {
    return name == "tree" ? tree : "";
  }
};
struct Cylinder {
  double length = 0.0, radius = 0.0;
  void SetLength(double value) { length = value; }
  void SetRadius(double value) { radius = value; }
};
enum class GeometryType { CYLINDER };
struct Geometry {
  Cylinder cylinder;
  void SetType(GeometryType) {}
  void SetCylinderShape(const Cylinder &shape) { cylinder = shape; }
};
struct Visual {
  Geometry geometry;
  void SetName(const std::string &) {}
  void SetGeom(const Geometry &value) { geometry = value; }
};

}  // namespace sdf

namespace gz::sim {

typedef uint64_t Entity;
constexpr Entity kNullEntity = 0;
enum class ComponentState { PeriodicChange };
struct EventManager {};

namespace components {
struct Pose {
  static constexpr int typeId = 1;
};
struct Wind {};
struct WorldLinearVelocity {
  math::Vector3d wind;
  const math::Vector3d &Data() const { return wind; }
};
}  // namespace components

struct EntityComponentManager {
  std::vector<sdf::Visual> visuals;
  std::vector<math::Pose3d> poses;
  components::WorldLinearVelocity wind{{-1.0, 8.0, 0.0}};
  template <class C>
  const C *Component(Entity) const {
    return &wind;
  }
  Entity EntityByComponents(const components::Wind &) const { return 1; }
  template <class C>
  void SetComponentData(Entity entity, const math::Pose3d &pose) {
    poses[entity] = pose;
  }
  void SetChanged(Entity, int, ComponentState) {}
};

// The model is turned to the left by a quarter.
inline math::Pose3d worldPose(Entity, const EntityComponentManager &) {
  return {0.0, 0.0, 0.0, 0.70710678118654752, 0.0, 0.0, 0.70710678118654752};
}

struct Model {
  explicit Model(Entity) {}
  Entity CanonicalLink(const EntityComponentManager &) const { return 1; }
};

struct SdfEntityCreator {
  EntityComponentManager &ecm;
  SdfEntityCreator(EntityComponentManager &manager, EventManager &) : ecm(manager) {}
  Entity CreateEntities(const sdf::Visual *visual) {
    ecm.visuals.push_back(*visual);
    ecm.poses.emplace_back();
    return ecm.poses.size() - 1;
  }
  void SetParent(Entity, Entity) {}
};

struct UpdateInfo {
  std::chrono::steady_clock::duration dt;
  bool paused = false;
};
struct System {
  virtual ~System() = default;
};
struct ISystemConfigure {
  virtual void Configure(const Entity &, const std::shared_ptr<const sdf::Element> &,
                         EntityComponentManager &, EventManager &) = 0;
};
struct ISystemPreUpdate {
  virtual void PreUpdate(const UpdateInfo &, EntityComponentManager &) = 0;
};

}  // namespace gz::sim

#include "tree_in_gazebo.cc"

static void print(const gz::math::Vector3d &v) { printf("%.9g %.9g %.9g\n", v.x, v.y, v.z); }

int main(int, char **arguments) {
  const gz::math::Pose3d turn(0.0, 0.0, 0.0, 0.5, 0.1, 0.7, -0.5);
  print(turn.Of({1.0, 2.0, 3.0}));
  TreeInGazebo tree;
  auto element = std::make_shared<sdf::Element>();
  element->tree = std::string(arguments[1]) + "/tree.sway";
  EntityComponentManager ecm;
  EventManager events;
  tree.Configure(1, element, ecm, events);
  // Two steps of the world are a 64th of a second.
  const UpdateInfo step{std::chrono::nanoseconds(7812500)};
  for (int count = 0; count < 128; count++) tree.PreUpdate(step, ecm);
  for (size_t i = 0; i < ecm.poses.size(); i++) {
    const sdf::Cylinder &wood = ecm.visuals[i].geometry.cylinder;
    print(ecm.poses[i].Of({0.0, 0.0, -0.5 * wood.length}));
    print(ecm.poses[i].Of({0.0, 0.0, 0.5 * wood.length}));
    print(ecm.poses[i].Of({wood.radius, 0.0, -0.5 * wood.length}));
  }
}
