#include "tests/bench/report/synthetic_run.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "bench/metrics/trajectory_file.h"
#include "bench/report/figures.h"
#include "bench/report/preview.h"
#include "slam/mapping/cloud_io.h"
#include "slam/mapping/map_io.h"
#include "tests/slam/types/centred_rig.h"

namespace groundloop::bench {
namespace {

/// Evenly spread number in [0, 1) of a counter, the same everywhere.
double spread(uint64_t counter) {
  uint64_t x = counter * 0x9e3779b97f4a7c15ULL + 0x7f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return static_cast<double>((x ^ (x >> 31)) >> 11) * 0x1.0p-53;
}

std::vector<Eigen::Vector2d> box(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

slam::OccupancyMap filled(const slam::GridGeometry& geometry, const auto& value_at) {
  slam::OccupancyMap map{geometry, {}};
  for (int row = 0; row < geometry.rows; ++row) {
    for (int col = 0; col < geometry.cols; ++col) map.value.push_back(value_at(geometry.centre_m(col, row)));
  }
  return map;
}

bool is_inside_room(const Eigen::Vector2d& p) {
  return p.x() > -0.1 && p.x() < 12.1 && p.y() > -0.1 && p.y() < 8.1;
}

std::vector<slam::PlyPoint> cloud() {
  std::vector<slam::PlyPoint> points;
  const slam::Pose T_map_world = SyntheticRun::T_world_map().inverse();
  for (uint64_t i = 0; i < 20000; ++i) {
    const double along = spread(4 * i) * 40, z = spread(4 * i + 1) * 2.4,
                 off = (spread(4 * i + 2) - 0.5) * 0.12;
    Eigen::Vector3d p(along, off, z);
    if (along > 12) p = {12 + off, along - 12, z};
    if (along > 20) p = {along - 20, 8 + off, z};
    if (along > 32) p = {off, along - 32, z};
    if (i % 7 == 0) p = {5.2 + spread(4 * i + 3) * 1.6, 3.6 + spread(4 * i + 2) * 0.8, 0.72 + off / 4};
    points.push_back({(T_map_world * p).cast<float>(), static_cast<uint8_t>(i % 256),
                      static_cast<float>(0.02 + 0.3 * spread(4 * i + 3))});
  }
  return points;
}

void write_tables(const std::string& dir) {
  slam::Trajectory truth, estimate;
  std::string key_frames = "index,stamp_ns,segment,x,y,z,qx,qy,qz,qw\n";
  std::string frames =
      "index,stamp_ns,status,segment,is_key_frame,features_tracked,inliers,residual_px,pyramid_ms,tracking_"
      "ms,"
      "registration_ms,detection_ms,disparity_ms,stereo_ms,mapping_ms,loop_ms,total_ms,render_ms,memory_mb,"
      "state_hash\n";
  for (int i = 0; i < SyntheticRun::kFrames; ++i) {
    const int64_t stamp_ns = SyntheticRun::stamp_ns(i);
    const slam::Pose T_map_left = SyntheticRun::T_map_left(i);
    truth.push_back({stamp_ns, SyntheticRun::T_world_left(i)});
    estimate.push_back({stamp_ns, T_map_left});
    const bool key = i % 6 == 0, lost = i >= SyntheticRun::kLostFrom && i < SyntheticRun::kLostTo;
    const double wave = 20 * std::sin(i * 0.05) + 12 * spread(static_cast<uint64_t>(i));
    const double k = key ? 1 : 0, s = 0.2 * spread(1000 + static_cast<uint64_t>(i));
    frames += fmt::format("{},{},{},0,{},{:.0f},{:.0f},0.31,{},{},{},{},{},{},{},0,{},55.5,{},{:016x}\n", i,
                          stamp_ns, lost ? "lost" : "tracking", key ? 1 : 0, 260 + wave,
                          lost ? 3 : 215 + wave, 0.8 + s, 2.5 + s, 0.9 + s, 3 * k, 6 * k, 1.5 * k, 2.5 * k,
                          4.2 + 3 * s + 13 * k, 200 + 0.1 * std::min(i, 150), 0xabcdef0000ULL + i);
    if (!key) continue;
    const Eigen::Quaterniond q(T_map_left.linear());
    const auto& t = T_map_left.translation();
    key_frames += fmt::format("{},{},0,{},{},{},{},{},{},{}\n", i, stamp_ns, t.x(), t.y(), t.z(), q.x(),
                              q.y(), q.z(), q.w());
  }
  write_tum(dir + "/truth.tum", truth);
  write_tum(dir + "/estimate.tum", estimate);
  write_text(dir + "/keyframes.csv", key_frames);
  write_text(dir + "/frames.csv", frames);
}

}  // namespace

void write_text(const std::string& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

slam::Pose SyntheticRun::T_world_map() {
  slam::Pose T = slam::Pose::Identity();
  T.linear() = slam::so3_exp({0, 0, M_PI / 2});
  T.translation() = Eigen::Vector3d(8.5, 4, 0);
  return T;
}

slam::Pose SyntheticRun::T_world_left(int frame) {
  const double angle = 2 * M_PI * 1.2 * frame / (kFrames - 1);
  slam::Pose T_world_body = slam::Pose::Identity();
  T_world_body.linear() = slam::so3_exp({0, 0, angle + M_PI / 2});
  T_world_body.translation() =
      Eigen::Vector3d(6 + kRadius_m * std::cos(angle), 4 + kRadius_m * std::sin(angle), 0);
  return T_world_body * slam::StereoRig::level_camera({0, 0.044, 0.35});
}

slam::Pose SyntheticRun::T_map_left(int frame) {
  slam::Pose T = T_world_left(frame);
  T.translation().z() += kError_m;
  return T_world_map().inverse() * T;
}

std::vector<Footprint> SyntheticRun::outline() {
  return {{"wall south", box(-0.1, -0.1, 12.1, 0)}, {"wall north", box(-0.1, 8, 12.1, 8.1)},
          {"wall west", box(-0.1, 0, 0, 8)},        {"wall east", box(12, 0, 12.1, 8)},
          {"desk", box(5.2, 3.6, 6.8, 4.4)},        {"cupboard <tall>", box(0, 6, 0.6, 8)}};
}

bool SyntheticRun::is_occupied(const Eigen::Vector2d& p_world) {
  for (const Footprint& thing : outline()) {
    if (p_world.x() > thing.polygon[0].x() && p_world.x() < thing.polygon[2].x() &&
        p_world.y() > thing.polygon[0].y() && p_world.y() < thing.polygon[2].y()) {
      return true;
    }
  }
  return false;
}

slam::OccupancyMap SyntheticRun::exact_map() {
  return filled({0.05, -0.2, -0.2, 248, 168}, [](const auto& p) { return is_occupied(p) ? 1.0F : 0.0F; });
}

slam::OccupancyMap SyntheticRun::estimated_map() {
  return filled({0.05, -5, -4, 200, 280}, [](const Eigen::Vector2d& p_map) {
    const Eigen::Vector2d p = (T_world_map() * Eigen::Vector3d(p_map.x(), p_map.y(), 0)).head<2>();
    if (!is_inside_room(p)) return slam::OccupancyMap::kUnknown;
    return is_occupied(p) ? 1.0F : 0.0F;
  });
}

slam::StereoRig SyntheticRun::rig() { return slam::centred_rig(640, 480, 800, 0.088); }

cv::Mat SyntheticRun::left_image() {
  cv::Mat image(480, 640, CV_8UC1);
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      const bool tile = (u / 40 + v / 40) % 2 == 0;
      image.at<uint8_t>(v, u) = static_cast<uint8_t>(80 + v / 6 + (tile ? 45 : 0));
    }
  }
  return image;
}

std::vector<slam::FeatureObservation> SyntheticRun::features() {
  std::vector<slam::FeatureObservation> list;
  for (int i = 0; i < 150; ++i) {
    slam::FeatureObservation f;
    f.id = i;
    f.u_left_px = static_cast<float>(30 + 42 * (i % 15));
    f.v_left_px = static_cast<float>(30 + 45 * (i / 15));
    f.u_right_px = f.u_left_px - static_cast<float>(8 + i / 15 * 4);
    f.v_right_px = f.v_left_px;
    f.has_right = i % 9 != 0;
    f.is_new = i % 5 == 0;
    f.is_inlier = !f.is_new && i % 11 != 0;
    list.push_back(f);
  }
  return list;
}

std::vector<std::vector<slam::FeatureObservation>> SyntheticRun::history() {
  std::vector<std::vector<slam::FeatureObservation>> frames;
  for (int age = 5; age >= 1; --age) {
    auto list = features();
    std::erase_if(list, [](const auto& f) { return f.is_new; });
    for (auto& f : list) {
      f.u_left_px -= static_cast<float>(1.5 * age);
      f.v_left_px -= static_cast<float>(0.002 * age * (f.v_left_px - 240));
    }
    frames.push_back(list);
  }
  return frames;
}

cv::Mat SyntheticRun::disparity() {
  cv::Mat d(240, 320, CV_16SC1);
  for (int v = 0; v < d.rows; ++v) {
    for (int u = 0; u < d.cols; ++u) {
      d.at<int16_t>(v, u) = u < 80 ? int16_t{-16} : static_cast<int16_t>(16 * (4 + 20.0 * v / d.rows));
    }
  }
  return d;
}

std::string synthetic_run_json(const std::string& result, const std::string& name) {
  return fmt::format(
      R"({{"version": "0.1.0", "name": "{}", "summary": "1.2 laps of a circle in a room of 12 m x 8 m", "seed": 7,
"kind": "run", "preset": "paper", "frames": {}, "isa": "avx2",
"renderer": {{"backend": "osmesa", "renderer": "llvmpipe", "version": "4.5", "samples": 4}},
"hashes": {{"scenario": "00ff00ff00ff00ff"}}, "argv": ["groundloop", "run", "synthetic.yaml"],
"verdict": {{"result": "{}", "lines": [
{{"metric": "trajectory.ate_rmse_m", "value": 0.25, "min": null, "max": 0.15, "ok": {}}},
{{"metric": "map.f1", "value": 0.87, "min": 0.6, "max": null, "ok": true}}]}}}})",
      name, SyntheticRun::kFrames, result, result == "pass");
}

void SyntheticRun::add_links(const std::string& dir) {
  write_text(
      dir + "/links.csv",
      "kind,from_index,to_index,x,y,z,qx,qy,qz,qw,inliers,residual_px,overlap,error_m,error_deg,right\n"
      "landmarks,0,250,0,0,0,0,0,0,1,80,0.4,0.9,0.01,0.1,1\n"
      "map,8,258,0,0,0,0,0,0,1,80,0,0.9,0.01,0.1,1\n"
      "landmarks,20,150,0,0,0,0,0,0,1,15,0.9,0,4.5,90,0\n");
  slam::Trajectory without_links;
  for (int i = 0; i < kFrames; ++i) {
    slam::Pose T = T_map_left(i);
    T.translation().x() += 0.4;
    without_links.push_back({stamp_ns(i), T});
  }
  write_tum(dir + "/without_links.tum", without_links);
}

void SyntheticRun::add_oracles(const std::string& dir) {
  write_text(
      dir + "/oracles.json",
      R"([{"exact": "", "outcome": "fell short", "metrics": {"trajectory.ate_rmse_m": 0.25, "map.f1": 0.87}},
{"exact": "tracking", "outcome": "pass", "metrics": {"trajectory.ate_rmse_m": 0.1}}])");
}

void SyntheticRun::write(const std::string& dir) {
  std::filesystem::create_directories(dir + "/figures");
  write_text(dir + "/run.json", synthetic_run_json("fell short"));
  write_text(dir + "/metrics.json",
             R"({"trajectory.ate_rmse_m": 0.25, "trajectory.end_yaw_deg": 0.4, "trajectory.length_m": 18.85,
"trajectory.lost_frames": 5, "map.f1": 0.87, "map.false_free_m2": 0.25, "stage.track_rmse_px": 0.1312,
"timing.slam_ms_median": 5.3, "timing.wall_s": 40.4, "timing.realtime_factor": 0.99, "peak_memory_mb": 312.5})");
  write_tables(dir);
  std::string numbers;
  const Eigen::Matrix4d T = T_world_map().matrix();
  for (int i = 0; i < 16; ++i) numbers += fmt::format("{}{}", i == 0 ? "" : ", ", T(i / 4, i % 4));
  write_text(dir + "/alignment.json", "{\"T_world_map\": [" + numbers + "]}");
  slam::write_ply(dir + "/cloud.ply", cloud());
  slam::write_map(dir + "/map", estimated_map());
  slam::write_map(dir + "/truth_map", exact_map());
  const auto g = exact_map().geometry;
  slam::write_map(dir + "/visible", filled(g, [](const auto& p) { return is_inside_room(p) ? 1.0F : 0.0F; }));
  std::string things;
  for (const Footprint& thing : outline()) {
    things += fmt::format("{}{{\"name\": \"{}\", \"polygon\": [", things.empty() ? "" : ",\n", thing.name);
    for (size_t i = 0; i < thing.polygon.size(); ++i) {
      things += fmt::format("{}[{}, {}]", i == 0 ? "" : ", ", thing.polygon[i].x(), thing.polygon[i].y());
    }
    things += "]}";
  }
  write_text(dir + "/outline.json", "[" + things + "]");

  std::vector<PlanPose> path;
  for (int i = 0; i < kFrames; ++i) {
    const Eigen::Vector3d p = T_world_left(i).translation();
    path.push_back({p.x(), p.y(), 0});
  }
  cv::imwrite(dir + "/figures/left.png", left_image());
  cv::imwrite(dir + "/figures/left_tracked.png", draw_tracked(left_image(), features(), history()));
  cv::imwrite(dir + "/figures/disparity.png", draw_disparity(disparity(), rig()));
  cv::imwrite(dir + "/figures/preview.png", draw_preview(outline(), path, {8.5, 4, M_PI / 2}));
}

}  // namespace groundloop::bench
