#include "sim/arm/arm_model.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "sim/robot/drive.h"

namespace groundloop::sim {
namespace {

slam::Pose pose_of(const mjtNum* pos, const mjtNum* quat) {
  slam::Pose T = slam::Pose::Identity();
  T.translation() << pos[0], pos[1], pos[2];
  T.linear() = Eigen::Quaterniond(quat[0], quat[1], quat[2], quat[3]).normalized().toRotationMatrix();
  return T;
}

int find_site(const mjModel& model, int body, std::string_view ending) {
  for (int site = 0; site < model.nsite; ++site) {
    const char* name = mj_id2name(&model, mjOBJ_SITE, site);
    if (name != nullptr && std::string_view(name).ends_with(ending) && model.site_bodyid[site] == body)
      return site;
  }
  return -1;
}

int only_child(const mjModel& model, int body) {
  int child = -1;
  for (int other = body + 1; other < model.nbody; ++other) {
    if (model.body_parentid[other] != body) continue;
    if (child >= 0) return -1;
    child = other;
  }
  return child;
}

int servo_of(const mjModel& model, int joint) {
  for (int actuator = 0; actuator < model.nu; ++actuator) {
    if (model.actuator_trntype[actuator] == mjTRN_JOINT && model.actuator_trnid[2 * actuator] == joint)
      return actuator;
  }
  return -1;
}

/// Collects what an arm lacks.
class ArmFinder {
 public:
  ArmFinder(const World& world, const std::string& robot_file)
      : world_(world), model_(world.model()), file_(robot_file) {}

  ArmModel find() {
    if (world_.robot_body() < 0 || model_.body_jntnum[world_.robot_body()] > 0) {
      throw InputError(
          Problem{file_, 0, "robot.model", "a robot that moves about",
                  "an arm, whose base stands, for plan.poses and plan.path (ur5e_xc55.xml is one)"});
    }
    find_chain();
    if (problems_.empty()) measure();
    for (const auto& [what, limit] :
         {std::pair("_joint_speed_radps", &arm_.joint_speed_radps),
          std::pair("_joint_acceleration_radps2", &arm_.joint_acceleration_radps2)}) {
      *limit = find_numeric(world_, what);
      if (!(*limit > 0)) missing(what, "<custom><numeric> whose name ends so, above 0");
    }
    if (!problems_.empty()) throw InputError(problems_);
    return arm_;
  }

 private:
  void missing(const std::string& what, const std::string& wanted) {
    problems_.push_back({file_, 0, what, "missing", wanted});
  }

  void find_chain() {
    arm_.bodies[0] = world_.robot_body();
    for (size_t i = 0; i < 6; ++i) {
      const int body = only_child(model_, arm_.bodies[i]);
      const bool turns = body >= 0 && model_.body_jntnum[body] == 1 &&
                         model_.jnt_type[model_.body_jntadr[body]] == mjJNT_HINGE;
      const int servo = turns ? servo_of(model_, model_.body_jntadr[body]) : -1;
      if (servo < 0) {
        return missing(fmt::format("joint {}", i + 1),
                       "six bodies in a chain, each on a hinge with a position servo");
      }
      arm_.bodies[i + 1] = body;
      const int joint = model_.body_jntadr[body];
      arm_.joints[i] = {model_.jnt_qposadr[joint], model_.jnt_dofadr[joint], servo,
                        model_.actuator_gainprm[mjNGAIN * servo],
                        model_.dof_damping[model_.jnt_dofadr[joint]]};
      const auto k = static_cast<Eigen::Index>(i);
      if (model_.jnt_limited[joint] == 0) continue;
      arm_.limits.low[k] = model_.jnt_range[2 * joint];
      arm_.limits.high[k] = model_.jnt_range[2 * joint + 1];
    }
  }

  slam::Pose T_parent(size_t i) const {
    return pose_of(model_.body_pos + 3 * arm_.bodies[i], model_.body_quat + 4 * arm_.bodies[i]);
  }

  /// Reads the lengths where the table has them, and holds the whole against the table.
  void measure() {
    arm_.T_world_base = T_parent(0);
    const int flange = find_site(model_, arm_.bodies[6], "_flange");
    const int camera = find_site(model_, arm_.bodies[6], "_camera");
    if (flange < 0) missing("_flange", "a site whose name ends so on the last body");
    if (camera < 0) missing("_camera", "a site whose name ends so on the last body");
    if (flange < 0 || camera < 0) return;
    const slam::Pose T_6_flange = pose_of(model_.site_pos + 3 * flange, model_.site_quat + 4 * flange);
    arm_.geometry = {T_parent(2).translation().z(), T_parent(3).translation().x(),
                     T_parent(4).translation().x(), T_parent(5).translation().z(),
                     T_parent(6).translation().z(), T_6_flange.translation().z()};
    arm_.T_flange_camera =
        T_6_flange.inverse() * pose_of(model_.site_pos + 3 * camera, model_.site_quat + 4 * camera);
    if (!fits()) {
      problems_.push_back(
          {file_, 0, "bodies of the arm", "other places or axes",
           "those of the UR family's Denavit-Hartenberg table, every joint about its body's z axis"});
    }
  }

  /// MuJoCo's kinematics against the table's, with every joint turned by an angle of its own.
  bool fits() const {
    const World::DataPtr state = world_.make_data();
    JointAngles q;
    q << 0.3, -1.1, 0.9, -0.5, 0.7, 1.3;
    arm_.set_angles(q, *state);
    mj_kinematics(&model_, state.get());
    const slam::Pose difference =
        arm_.T_world_flange(*state).inverse() * arm_.T_world_base * forward_kinematics(arm_.geometry, q);
    return slam::se3_log(difference).norm() < 1e-6 * arm_.geometry.reach_m();
  }

  const World& world_;
  const mjModel& model_;
  const std::string& file_;
  std::vector<Problem> problems_;
  ArmModel arm_;
};

}  // namespace

JointAngles ArmModel::angles(const mjData& state) const {
  JointAngles q;
  for (int i = 0; i < 6; ++i) q[i] = state.qpos[joints[static_cast<size_t>(i)].qpos];
  return q;
}

void ArmModel::set_angles(const JointAngles& q, mjData& state) const {
  for (int i = 0; i < 6; ++i) state.qpos[joints[static_cast<size_t>(i)].qpos] = q[i];
}

slam::Pose ArmModel::T_world_flange(const mjData& state) const {
  slam::Pose T_world_6 = slam::Pose::Identity();
  T_world_6.translation() = Eigen::Map<const Eigen::Vector3d>(state.xpos + 3 * bodies[6]);
  T_world_6.linear() =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(state.xmat + 9 * bodies[6]);
  return T_world_6 * Eigen::Translation3d(0, 0, geometry.d6_m);
}

ArmModel find_arm(const World& world, const std::string& robot_file) {
  return ArmFinder(world, robot_file).find();
}

}  // namespace groundloop::sim
