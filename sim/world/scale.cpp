#include "sim/world/scale.h"

#include <memory>

namespace groundloop::sim {
namespace {

template <class T>
void multiply(T* values, int count, double factor) {
  for (int i = 0; i < count; ++i) values[i] = static_cast<T>(values[i] * factor);
}

/// Coordinates of joints that are lengths; angles stay.
void scale_joints(mjModel& model, double factor) {
  multiply(model.jnt_pos, 3 * model.njnt, factor);
  for (int joint = 0; joint < model.njnt; ++joint) {
    const int type = model.jnt_type[joint];
    if (type != mjJNT_FREE && type != mjJNT_SLIDE) continue;
    const int lengths = type == mjJNT_FREE ? 3 : 1;
    multiply(model.qpos0 + model.jnt_qposadr[joint], lengths, factor);
    multiply(model.qpos_spring + model.jnt_qposadr[joint], lengths, factor);
    if (type == mjJNT_SLIDE) multiply(model.jnt_range + 2 * joint, 2, factor);
  }
}

/// A texture that repeats so many times a metre.
void scale_materials(mjModel& model, double factor) {
  for (int material = 0; material < model.nmat; ++material) {
    if (model.mat_texuniform[material] != 0) multiply(model.mat_texrepeat + 2 * material, 2, 1 / factor);
  }
}

void scale_lights(mjModel& model, double factor) {
  multiply(model.light_pos, 3 * model.nlight, factor);
  for (int light = 0; light < model.nlight; ++light) {
    float* attenuation = model.light_attenuation + 3 * light;  // constant, by distance, by its square
    multiply(attenuation + 1, 1, 1 / factor);
    multiply(attenuation + 2, 1, 1 / (factor * factor));
  }
}

}  // namespace

void scale_model(mjModel& model, double factor) {
  multiply(model.body_pos, 3 * model.nbody, factor);
  multiply(model.body_ipos, 3 * model.nbody, factor);
  multiply(model.body_mass, model.nbody, 1 / (factor * factor));
  scale_joints(model, factor);
  multiply(model.geom_pos, 3 * model.ngeom, factor);
  multiply(model.geom_size, 3 * model.ngeom, factor);
  multiply(model.geom_rbound, model.ngeom, factor);
  multiply(model.site_pos, 3 * model.nsite, factor);
  multiply(model.site_size, 3 * model.nsite, factor);
  multiply(model.cam_pos, 3 * model.ncam, factor);
  multiply(model.mesh_vert, 3 * model.nmeshvert, factor);
  multiply(model.hfield_size, 4 * model.nhfield, factor);
  scale_materials(model, factor);
  scale_lights(model, factor);
  const std::unique_ptr<mjData, decltype(&mj_deleteData)> data(mj_makeData(&model), mj_deleteData);
  const mjStatistic before = model.stat;
  mj_setConst(&model, data.get());
  model.stat.extent = factor * before.extent;  // as the file may have set them
  for (int i = 0; i < 3; ++i) model.stat.center[i] = factor * before.center[i];
}

}  // namespace groundloop::sim
