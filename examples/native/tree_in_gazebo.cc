// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Gazebo (Harmonic): the link of a static model gets a cylinder for each segment, which sways in
// the world's wind; axes and units are ours.
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include <gz/common/Console.hh>
#include <gz/math/Pose3.hh>
#include <gz/plugin/Register.hh>
#include <gz/sim/Model.hh>
#include <gz/sim/SdfEntityCreator.hh>
#include <gz/sim/System.hh>
#include <gz/sim/Util.hh>
#include <gz/sim/components/LinearVelocity.hh>
#include <gz/sim/components/Pose.hh>
#include <gz/sim/components/Wind.hh>
#include <sdf/Cylinder.hh>
#include <sdf/Geometry.hh>
#include <sdf/Visual.hh>

#include "sway.hpp"

using namespace gz::sim;

class TreeInGazebo : public System, public ISystemConfigure, public ISystemPreUpdate {
public:
  void Configure(const Entity &entity, const std::shared_ptr<const sdf::Element> &element,
                 EntityComponentManager &ecm, EventManager &events) override {
    if (!tree_.open(element->Get<std::string>("tree"))) gzerr << tree_.error << std::endl;
    link_ = Model(entity).CanonicalLink(ecm);
    SdfEntityCreator creator(ecm, events);
    for (size_t i = 0; i < tree_.lengths.size(); i++) {
      sdf::Cylinder cylinder;
      cylinder.SetLength(tree_.lengths[i]);
      cylinder.SetRadius(0.5 * tree_.diameters[i]);
      sdf::Geometry geometry;
      geometry.SetType(sdf::GeometryType::CYLINDER);
      geometry.SetCylinderShape(cylinder);
      sdf::Visual visual;
      visual.SetName("segment_" + std::to_string(i));
      visual.SetGeom(geometry);
      wood_.push_back(creator.CreateEntities(&visual));
      creator.SetParent(wood_.back(), link_);
    }
  }

  // Steps of the world are shorter than those that a picture needs.
  void PreUpdate(const UpdateInfo &info, EntityComponentManager &ecm) override {
    if (!info.paused) since_ += std::chrono::duration<double>(info.dt).count();
    if (since_ < 0.015) return;
    gz::math::Vector3d wind;
    const auto *velocity =
        ecm.Component<components::WorldLinearVelocity>(ecm.EntityByComponents(components::Wind()));
    if (velocity) wind = worldPose(link_, ecm).Rot().RotateVectorReverse(velocity->Data());
    tree_.step(wind.X(), wind.Y(), wind.Z(), since_);
    since_ = 0.0;
    for (size_t i = 0; i < wood_.size(); i++) {
      const double *p = &tree_.poses[7 * i];
      const gz::math::Pose3d start(p[0], p[1], p[2], p[6], p[3], p[4], p[5]);
      // A cylinder stands on z, a segment lies on x.
      const gz::math::Pose3d middle(0.5 * tree_.lengths[i], 0.0, 0.0, 0.0, GZ_PI_2, 0.0);
      ecm.SetComponentData<components::Pose>(wood_[i], start * middle);
      ecm.SetChanged(wood_[i], components::Pose::typeId, ComponentState::PeriodicChange);
    }
  }

private:
  sway::Tree tree_;
  Entity link_ = kNullEntity;
  std::vector<Entity> wood_;
  double since_ = 0.0;
};

GZ_ADD_PLUGIN(TreeInGazebo, System, ISystemConfigure, ISystemPreUpdate)
