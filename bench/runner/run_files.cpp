#include "bench/runner/run_files.h"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "slam/mapping/atomic_file.h"
#include "slam/mapping/cloud_io.h"
#include "slam/mapping/map_io.h"

namespace groundloop::bench {
namespace {

using Json = nlohmann::ordered_json;

void write_json(const std::string& file, const Json& json, int indent) {
  slam::write_file_atomically(file, [&](std::ostream& out) { out << json.dump(indent) << "\n"; });
}

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

/// A number that reads back exactly; an empty cell where it is not one.
std::string cell(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

/// x,y,z,qx,qy,qz,qw
std::string pose_cells(const slam::Pose& T) {
  const Eigen::Vector3d t = T.translation();
  const Eigen::Quaterniond q(T.linear());
  return fmt::format("{},{},{},{},{},{},{}", t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
}

}  // namespace

void write_run_json(const std::string& file, const RunHeader& header) {
  Json json;
  json["version"] = header.version;
  json["name"] = header.name;
  json["summary"] = header.summary;
  json["seed"] = header.seed;
  json["kind"] = header.kind;
  json["preset"] = header.preset;
  if (!header.oracles.empty()) json["oracles"] = header.oracles;
  json["frames"] = header.frames;
  json["renderer"] = header.renderer;
  json["isa"] = header.isa;
  json["hashes"] = header.hashes;
  json["verdict"]["result"] = header.result;
  json["verdict"]["lines"] = Json::array();
  for (const JudgedMetric& judged : header.judged) {
    json["verdict"]["lines"].push_back({{"metric", judged.metric},
                                        {"value", or_null(judged.value)},
                                        {"min", or_null(judged.min)},
                                        {"max", or_null(judged.max)},
                                        {"ok", judged.ok}});
  }
  write_json(file, json, 2);
}

void write_metrics_json(const std::string& file, const Metrics& metrics) {
  slam::write_file_atomically(file, [&](std::ostream& out) { out << to_json(metrics) << "\n"; });
}

void write_frames_csv(const std::string& file, const std::vector<slam::FrameResult>& frames,
                      const std::vector<FrameNotes>& notes) {
  slam::write_file_atomically(file, [&](std::ostream& out) {
    out << "index,stamp_ns,status,segment,is_key_frame,features_tracked,inliers,residual_px,right_late_s";
    for (size_t s = 0; s < slam::kStageCount; ++s) {
      out << "," << slam::name_of(static_cast<slam::Stage>(s)) << "_ms";
    }
    out << ",total_ms,render_ms,memory_mb,disparity_error_px,track_error_px,position_error_m,exposure_s,"
           "gain_db,faults,state_hash\n";
    for (size_t i = 0; i < frames.size(); ++i) {
      const slam::FrameResult& f = frames[i];
      fmt::print(out, "{},{},{},{},{:d},{},{},{},{}", f.index, f.stamp_ns, slam::name_of(f.status), f.segment,
                 f.is_key_frame, f.features_tracked, f.inliers, f.residual_px, f.right_late_s);
      for (const double ms : f.stage_ms) fmt::print(out, ",{:.3f}", ms);
      const FrameNotes& n = notes[i];
      fmt::print(out, ",{:.3f},{},{:.1f},{},{},{},{},{},{},{:016x}\n", f.total_ms,
                 std::isfinite(n.render_ms) ? fmt::format("{:.3f}", n.render_ms) : "", n.memory_mb,
                 cell(n.disparity_error_px), cell(n.track_error_px), cell(n.position_error_m),
                 cell(n.exposure_s), cell(n.gain_db), n.faults, f.state_hash);
    }
  });
}

void write_key_frames_csv(const std::string& file, const std::vector<slam::KeyFrameRecord>& key_frames) {
  slam::write_file_atomically(file, [&](std::ostream& out) {
    out << "index,stamp_ns,segment,x,y,z,qx,qy,qz,qw";
    out << ",motion_x,motion_y,motion_z,motion_qx,motion_qy,motion_qz,motion_qw";
    for (int row = 0; row < 6; ++row) {
      for (int col = row; col < 6; ++col) fmt::print(out, ",c{}{}", row, col);
    }
    out << "\n";
    for (const slam::KeyFrameRecord& k : key_frames) {
      fmt::print(out, "{},{},{},{},{}", k.index, k.stamp_ns, k.segment, pose_cells(k.T_map_left),
                 pose_cells(k.T_previous_left));
      for (int row = 0; row < 6; ++row) {
        for (int col = row; col < 6; ++col) fmt::print(out, ",{}", k.covariance(row, col));
      }
      out << "\n";
    }
  });
}

void write_links_csv(const std::string& file, const std::vector<JudgedLink>& links) {
  slam::write_file_atomically(file, [&](std::ostream& out) {
    out << "kind,from_index,to_index,x,y,z,qx,qy,qz,qw,inliers,residual_px,overlap,error_m,error_deg,right\n";
    for (const JudgedLink& judged : links) {
      const slam::LoopLink& l = judged.link;
      fmt::print(out, "{},{},{},{},{},{},{},{},{},{}\n",
                 l.kind == slam::LinkKind::kLandmarks ? "landmarks" : "map", l.from_index, l.to_index,
                 pose_cells(l.T_from_to), l.inliers, l.residual_px, cell(judged.overlap),
                 cell(judged.error_m), cell(judged.error_deg),
                 std::isfinite(judged.error_m) ? (judged.right ? "1" : "0") : "");
    }
  });
}

void write_cloud_ply(const std::string& file, const std::vector<slam::CloudPoint>& cloud) {
  std::vector<slam::PlyPoint> points;
  points.reserve(cloud.size());
  for (const slam::CloudPoint& p : cloud) points.push_back({p.p_map.cast<float>(), p.grey, p.sigma_m});
  slam::write_ply(file, points);
}

void write_alignment_json(const std::string& file, const slam::Pose& T_world_map) {
  Json json;
  for (int row = 0; row < 4; ++row) {
    for (int col = 0; col < 4; ++col) json["T_world_map"].push_back(T_world_map.matrix()(row, col));
  }
  write_json(file, json, -1);
}

void write_outline_json(const std::string& file, const std::vector<Footprint>& outline) {
  Json json = Json::array();
  for (const Footprint& footprint : outline) {
    Json polygon = Json::array();
    for (const Eigen::Vector2d& corner : footprint.polygon) polygon.push_back({corner.x(), corner.y()});
    json.push_back({{"name", footprint.name}, {"polygon", polygon}});
  }
  write_json(file, json, -1);
}

void write_map3d(const std::string& folder, const std::vector<slam::OccupancyMap>& layers,
                 const std::vector<double>& layer_heights_m) {
  std::filesystem::create_directories(folder);
  slam::write_octomap(folder + "/map.bt", layers, layer_heights_m);
  for (size_t i = 0; i < layers.size(); ++i)
    slam::write_map(fmt::format("{}/layer_{}", folder, i), layers[i]);
}

}  // namespace groundloop::bench
