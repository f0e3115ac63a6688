// groundloop eval: how far one trajectory is from another.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "bench/cli/arguments.h"
#include "bench/cli/commands.h"
#include "bench/metrics/alignment.h"
#include "bench/metrics/point_truth.h"
#include "bench/metrics/pose_error.h"
#include "bench/metrics/statistics.h"
#include "bench/metrics/trajectory_file.h"
#include "bench/metrics/trajectory_metrics.h"

namespace groundloop::bench {
namespace {

using nlohmann::ordered_json;

struct EvalOptions {
  std::string truth, estimate;
  std::string format = "auto";
  AlignMode align = AlignMode::kSe3;
  std::optional<size_t> n_to_align;
  AssociationOptions association;
  RelativeOptions rpe;  ///< its relation is also that of the APE
  std::string up = "auto";
  bool planar = false;
  bool json = false;
};

TrajectoryFile read(const std::string& file, const std::string& format, bool is_truth) {
  // An estimate beside a EuRoC truth is usually TUM, so there only the truth is held to the format.
  if (format == "auto" || (format == "euroc" && !is_truth)) return read_trajectory(file);
  for (const auto& [value, name] : EnumNames<TrajectoryFormat>::names) {
    if (format == name) return read_trajectory(file, value);
  }
  throw InputError(Problem{"", 0, "--format", format, "one of: auto, tum, kitti, euroc"});
}

PosePairs paired(const TrajectoryFile& truth, const TrajectoryFile& estimate,
                 const AssociationOptions& options) {
  if (truth.has_stamps() != estimate.has_stamps()) {
    throw InputError(
        Problem{estimate.file, 0, "", estimate.has_stamps() ? "has stamps" : "has no stamps",
                "the same as the truth, since KITTI poses are paired by line and others by time"});
  }
  if (!truth.has_stamps()) {
    if (truth.poses.size() != estimate.poses.size()) {
      throw InputError(Problem{estimate.file, 0, "", fmt::format("{} poses", estimate.poses.size()),
                               fmt::format("{} poses, as many as the truth has", truth.poses.size())});
    }
    return {truth.poses, estimate.poses};
  }
  PosePairs pairs = associate_by_time(truth.poses, estimate.poses, options);
  if (pairs.size() == 0) {
    throw InputError(
        Problem{estimate.file, 0, "", "no stamp agrees with the truth's",
                fmt::format("stamps within {} s (--max-diff, --offset)", options.max_difference_s)});
  }
  return pairs;
}

Eigen::Vector3d up_of(const std::string& axis, bool has_stamps) {
  // KITTI truth is in the frame of the first left camera, whose y axis points down.
  const std::string name = axis == "auto" ? (has_stamps ? "z" : "-y") : axis;
  const double sign = name.front() == '-' ? -1 : 1;
  return sign * Eigen::Vector3d::Unit(name.back() - 'x');
}

template <class E>
const char* name_in(E value) {
  for (const auto& [candidate, name] : EnumNames<E>::names) {
    if (candidate == value) return name;
  }
  return "";
}

void append(ordered_json& json, const Statistics& s) {
  json["rmse"] = s.rmse, json["mean"] = s.mean, json["median"] = s.median, json["std"] = s.std;
  json["min"] = s.min, json["max"] = s.max, json["sse"] = s.sse;
}

ordered_json described(const TrajectoryFile& file) {
  return {{"file", file.file}, {"format", name_in(file.format)}, {"poses", file.poses.size()}};
}

std::string row(const std::string& label, const Statistics& s) {
  return fmt::format("{:<22}{:>12.6f}{:>12.6f}{:>12.6f}{:>12.6f}{:>12.6f}{:>12.6f}{:>14.6f}\n", label, s.rmse,
                     s.mean, s.median, s.std, s.min, s.max, s.sse);
}

/// Everything eval found out.
struct Evaluation {
  TrajectoryFile truth, estimate;
  size_t pairs = 0;
  Alignment alignment;
  Statistics ape;
  std::vector<double> rpe_errors;
  Metrics metrics;
};

Evaluation evaluate(const EvalOptions& options) {
  Evaluation result;
  result.truth = read(options.truth, options.format, true);
  result.estimate = read(options.estimate, options.format, false);
  PosePairs pairs = paired(result.truth, result.estimate, options.association);
  result.pairs = pairs.size();
  result.metrics = trajectory_metrics(pairs, up_of(options.up, result.truth.has_stamps()));
  result.alignment = align(pairs, options.align, options.n_to_align);
  result.ape = statistics(absolute_errors(pairs, options.rpe.relation));
  result.rpe_errors = relative_errors(pairs, options.rpe);
  return result;
}

void print_json(const EvalOptions& options, const Evaluation& result) {
  ordered_json ape = {{"relation", name_in(options.rpe.relation)},
                      {"unit", unit_of(options.rpe.relation)},
                      {"n", result.pairs}};
  append(ape, result.ape);
  ordered_json rpe = {{"relation", name_in(options.rpe.relation)},
                      {"unit", unit_of(options.rpe.relation)},
                      {"delta", options.rpe.delta},
                      {"delta_unit", name_in(options.rpe.unit)},
                      {"all_pairs", options.rpe.all_pairs},
                      {"pairs_from_reference", options.rpe.pairs_from_reference},
                      {"n", result.rpe_errors.size()}};
  if (!result.rpe_errors.empty()) append(rpe, statistics(result.rpe_errors));
  const ordered_json json = {{"truth", described(result.truth)},
                             {"estimate", described(result.estimate)},
                             {"pairs", result.pairs},
                             {"align",
                              {{"mode", name_in(options.align)},
                               {"scale", result.alignment.scale},
                               {"unique", result.alignment.unique}}},
                             {"ape", ape},
                             {"rpe", rpe},
                             {"metrics", result.metrics}};
  fmt::print("{}\n", json.dump(2));
}

void print_text(const EvalOptions& options, const Evaluation& result) {
  fmt::print("truth     {} ({}, {} poses)\nestimate  {} ({}, {} poses)\n", result.truth.file,
             name_in(result.truth.format), result.truth.poses.size(), result.estimate.file,
             name_in(result.estimate.format), result.estimate.poses.size());
  fmt::print("pairs     {}, aligned: {}{}\n\n", result.pairs, name_in(options.align),
             result.alignment.scale == 1 ? "" : fmt::format(", scale {:.6f}", result.alignment.scale));
  const std::string unit = unit_of(options.rpe.relation);
  const std::string relation = name_in(options.rpe.relation) + (unit.empty() ? "" : " [" + unit + "]");
  fmt::print("{:<22}{:>12}{:>12}{:>12}{:>12}{:>12}{:>12}{:>14}\n", relation, "rmse", "mean", "median", "std",
             "min", "max", "sse");
  fmt::print("{}", row("APE", result.ape));
  const std::string rpe = fmt::format("RPE {:g} {}, {} pairs", options.rpe.delta, name_in(options.rpe.unit),
                                      result.rpe_errors.size());
  if (!result.rpe_errors.empty()) fmt::print("{}", row(rpe, statistics(result.rpe_errors)));
  fmt::print("\n");
  for (const auto& [name, value] : result.metrics) fmt::print("{:<32}{:>14.6f}\n", name, value);
}

int eval_planar(const EvalOptions& options) {
  const PointTruth truth = read_point_truth(options.truth);
  const TrajectoryFile estimate = read(options.estimate, "tum", false);
  const auto fit = fit_planar(truth, estimate.poses);
  if (!fit) {
    throw InputError(Problem{options.estimate, 0, "", fmt::format("{} poses", estimate.poses.size()),
                             "at least 3 poses, to fit the lever arm"});
  }
  const Metrics metrics = planar_metrics(*fit);
  const Eigen::Vector3d& lever = fit->p_left_point;
  if (options.json) {
    const ordered_json json = {{"poses", estimate.poses.size()},
                               {"lever_arm_m", {lever.x(), lever.y(), lever.z()}},
                               {"height_rms_m", fit->height_rms_m},
                               {"metrics", metrics}};
    fmt::print("{}\n", json.dump(2));
  } else {
    for (const auto& [name, value] : metrics) fmt::print("{:<32}{:>14.6f}\n", name, value);
    fmt::print("{:<32}{:>14.6f}\n", "height rms [m]", fit->height_rms_m);
    fmt::print("{:<32}{:>14.3f}{:>10.3f}{:>10.3f}\n", "lever arm in the camera [m]", lever.x(), lever.y(),
               lever.z());
  }
  return 0;
}

int eval(const EvalOptions& options, bool delta_was_given) {
  if (options.planar) return eval_planar(options);
  if (options.rpe.unit == DeltaUnit::kFrames && options.rpe.delta < 1) {
    throw InputError(
        Problem{"", 0, "--rpe-delta", fmt::format("{:g}", options.rpe.delta), "at least 1 frame"});
  }
  const Evaluation result = evaluate(options);
  if (delta_was_given && result.rpe_errors.empty()) {
    throw InputError(Problem{options.estimate, 0, "--rpe-delta",
                             fmt::format("{:g} {}", options.rpe.delta, name_in(options.rpe.unit)),
                             "a length that some part of the trajectory has"});
  }
  if (!result.alignment.unique) {
    fmt::print(stderr, "groundloop: the positions lie on a line, so the alignment leaves a rotation open\n");
  }
  if (options.json) {
    print_json(options, result);
  } else {
    print_text(options, result);
  }
  return 0;
}

}  // namespace

void add_eval_command(CLI::App& app, CommandAction& action) {
  CLI::App* command = app.add_subcommand("eval", "metrics of any two trajectories (TUM, KITTI, EuRoC csv)");
  const auto options = std::make_shared<EvalOptions>();
  command->add_option("--truth", options->truth, "true trajectory")->required()->type_name("FILE");
  command->add_option("--estimate", options->estimate, "estimated trajectory")->required()->type_name("FILE");
  command->add_option("--format", options->format, "auto (told from the columns), tum, kitti or euroc")
      ->check(CLI::IsMember({"auto", "tum", "kitti", "euroc"}))
      ->capture_default_str()
      ->type_name("NAME");
  add_choice(*command, "--align", options->align, "how the estimate is laid on the truth, for APE and RPE");
  command->add_option("--n-to-align", options->n_to_align, "align by the first N poses only")
      ->check(CLI::PositiveNumber)
      ->type_name("N");
  command
      ->add_option("--max-diff", options->association.max_difference_s,
                   "largest difference of paired stamps [s]")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str()
      ->type_name("S");
  command->add_option("--offset", options->association.offset_s, "added to the estimate's stamps [s]")
      ->capture_default_str()
      ->type_name("S");
  add_choice(*command, "-r,--relation", options->rpe.relation, "which error, for APE and RPE");
  CLI::Option* delta =
      command->add_option("-d,--rpe-delta", options->rpe.delta, "length of the sub-trajectories of the RPE")
          ->check(CLI::PositiveNumber)
          ->capture_default_str()
          ->type_name("D");
  add_choice(*command, "-u,--rpe-unit", options->rpe.unit, "its unit: frames, metres, degrees, radians");
  command->add_flag("--all-pairs", options->rpe.all_pairs, "a sub-trajectory from every pose");
  command->add_flag("--pairs-from-reference", options->rpe.pairs_from_reference,
                    "measure the sub-trajectories on the truth");
  command
      ->add_option("--up", options->up, "vertical of the truth's frame, for end_yaw_deg; auto: z, KITTI -y")
      ->check(CLI::IsMember({"auto", "x", "y", "z", "-x", "-y", "-z"}))
      ->capture_default_str()
      ->type_name("NAME");
  command->add_flag(
      "--planar", options->planar,
      "the truth knows only the place of one point of the robot on the floor; its lever arm is fitted");
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options, delta, &action] {
    action = [options, given = delta->count() > 0] { return eval(*options, given); };
  });
}

}  // namespace groundloop::bench
