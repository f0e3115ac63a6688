#pragma once

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cstring>
#include <memory>
#include <string>

namespace groundloop::sim {

/// A MuJoCo model from the inside of <worldbody>, with its state computed.
struct Scene {
  explicit Scene(const std::string& worldbody, const std::string& asset = "") {
    const std::string xml = "<mujoco><compiler angle='degree'/><asset>" + asset + "</asset><worldbody>" +
                            worldbody + "</worldbody></mujoco>";
    const auto vfs = std::make_unique<mjVFS>();
    mj_defaultVFS(vfs.get());
    mj_makeEmptyFileVFS(vfs.get(), "scene.xml", static_cast<int>(xml.size()));
    std::memcpy(vfs->filedata[mj_findFileVFS(vfs.get(), "scene.xml")], xml.data(), xml.size());
    char error[1000] = "";
    model.reset(mj_loadXML("scene.xml", vfs.get(), error, sizeof(error)));
    mj_deleteVFS(vfs.get());
    if (!model) throw std::runtime_error(error);
    data.reset(mj_makeData(model.get()));
    mj_forward(model.get(), data.get());
  }

  int geom(const char* name) const { return mj_name2id(model.get(), mjOBJ_GEOM, name); }
  int body(const char* name) const { return mj_name2id(model.get(), mjOBJ_BODY, name); }

  std::unique_ptr<mjModel, decltype(&mj_deleteModel)> model{nullptr, mj_deleteModel};
  std::unique_ptr<mjData, decltype(&mj_deleteData)> data{nullptr, mj_deleteData};
};

/// A pyramid over a square, as a mesh asset "pyramid": base |x|, |y| <= 1 at z = 0, tip (0, 0, 1.5).
inline const char* const kPyramidAsset =
    "<mesh name='pyramid' vertex='-1 -1 0  1 -1 0  1 1 0  -1 1 0  0 0 1.5' "
    "face='0 1 4  1 2 4  2 3 4  3 0 4  0 2 1  0 3 2'/>";

}  // namespace groundloop::sim
