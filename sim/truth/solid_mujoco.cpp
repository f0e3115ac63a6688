#include <stdexcept>
#include <string>
#include <vector>

#include "sim/truth/solid.h"

namespace groundloop::sim {

using Eigen::Vector3d;
using Eigen::Vector3i;

Triangles mesh_triangles(const mjModel& model, int mesh) {
  Triangles out;
  out.vertices = Eigen::Map<const Eigen::Matrix3Xf>(model.mesh_vert + 3 * model.mesh_vertadr[mesh], 3,
                                                    model.mesh_vertnum[mesh])
                     .cast<double>();
  out.corners = Eigen::Map<const Eigen::Matrix3Xi>(model.mesh_face + 3 * model.mesh_faceadr[mesh], 3,
                                                   model.mesh_facenum[mesh]);
  return out;
}

Triangles height_field_triangles(const mjModel& model, int height_field) {
  const int rows = model.hfield_nrow[height_field], cols = model.hfield_ncol[height_field];
  const mjtNum* size =
      model.hfield_size + 4 * height_field;  // half x, half y, height of data 1, depth of the base
  const float* data = model.hfield_data + model.hfield_adr[height_field];

  // grid points, then the points of the border once more on the base
  std::vector<Vector3d> points;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      points.emplace_back(size[0] * (2.0 * c / (cols - 1) - 1), size[1] * (2.0 * r / (rows - 1) - 1),
                          size[2] * data[r * cols + c]);
    }
  }
  std::vector<int> border;  // counter-clockwise from above
  border.reserve(2 * static_cast<size_t>(rows + cols));
  for (int c = 0; c < cols - 1; ++c) border.push_back(c);
  for (int r = 0; r < rows - 1; ++r) border.push_back(r * cols + cols - 1);
  for (int c = cols - 1; c > 0; --c) border.push_back((rows - 1) * cols + c);
  for (int r = rows - 1; r > 0; --r) border.push_back(r * cols);
  const int base = static_cast<int>(points.size());
  for (const int i : border) points.emplace_back(points[i].x(), points[i].y(), -size[3]);

  std::vector<Vector3i> corners;
  for (int r = 0; r + 1 < rows; ++r) {
    for (int c = 0; c + 1 < cols; ++c) {
      const int i = r * cols + c;
      corners.emplace_back(i, i + 1, i + cols + 1);
      corners.emplace_back(i, i + cols + 1, i + cols);
    }
  }
  const int n = static_cast<int>(border.size());
  for (int k = 0; k < n; ++k) {
    const int next = (k + 1) % n;
    corners.emplace_back(border[k], base + k, base + next);
    corners.emplace_back(border[k], base + next, border[next]);
    if (k > 0 && next > 0) corners.emplace_back(base, base + next, base + k);
  }

  Triangles out;
  out.vertices.resize(3, static_cast<Eigen::Index>(points.size()));
  for (size_t i = 0; i < points.size(); ++i) out.vertices.col(static_cast<Eigen::Index>(i)) = points[i];
  out.corners.resize(3, static_cast<Eigen::Index>(corners.size()));
  for (size_t i = 0; i < corners.size(); ++i) out.corners.col(static_cast<Eigen::Index>(i)) = corners[i];
  return out;
}

std::unique_ptr<Solid> make_solid(const mjModel& model, int geom) {
  const mjtNum* size = model.geom_size + 3 * geom;
  const auto half_of_plane = [](mjtNum half) { return half > 0 ? half : kUnboundedHalf_m; };
  switch (model.geom_type[geom]) {
    case mjGEOM_PLANE:
      return make_box({half_of_plane(size[0]), half_of_plane(size[1]), 0});
    case mjGEOM_BOX:
      return make_box({size[0], size[1], size[2]});
    case mjGEOM_SPHERE:
      return make_ellipsoid(Vector3d::Constant(size[0]));
    case mjGEOM_ELLIPSOID:
      return make_ellipsoid({size[0], size[1], size[2]});
    case mjGEOM_CAPSULE:
      return make_capsule(size[0], size[1]);
    case mjGEOM_CYLINDER:
      return make_cylinder(size[0], size[1]);
    case mjGEOM_MESH:
      return make_triangles(mesh_triangles(model, model.geom_dataid[geom]));
    case mjGEOM_HFIELD:
      return make_triangles(height_field_triangles(model, model.geom_dataid[geom]));
    default:
      throw std::invalid_argument("geom type " + std::to_string(model.geom_type[geom]) + " has no surface");
  }
}

}  // namespace groundloop::sim
