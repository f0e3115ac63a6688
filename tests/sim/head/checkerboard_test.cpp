// The head's own images of a checkerboard, rendered by MuJoCo and taken through lens, sensor and shutter:
// OpenCV's calibration finds the head that was configured, within three of its own standard deviations.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Dense>
#include <array>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "sim/head/head.h"
#include "sim/render/renderer.h"
#include "sim/world/world.h"

namespace groundloop::sim {
namespace {

constexpr double kSquare_m = 0.04;
constexpr int kViews = 16;
const cv::Size kCorners(9, 6);  ///< between 10 x 7 squares
constexpr uint64_t kSeed = 3;

using Corners = std::vector<cv::Point2f>;
using View = std::array<Corners, 2>;  ///< left, right

/// A white plate with black squares 10 micrometres thick, in the plane z = 0, and the world's own plain
/// light.
World board() {
  std::string squares;
  for (int row = 0; row <= kCorners.height; ++row) {
    for (int col = row % 2; col <= kCorners.width; col += 2) {
      squares += fmt::format("<geom type='box' material='black' size='{0} {0} 1e-5' pos='{1} {2} 0'/>",
                             kSquare_m / 2, (col - 0.5 * kCorners.width) * kSquare_m,
                             (row - 0.5 * kCorners.height) * kSquare_m);
    }
  }
  const auto file = std::filesystem::temp_directory_path() / fmt::format("groundloop_board_{}.xml", getpid());
  std::ofstream(file)
      << "<mujoco><statistic extent='1'/><visual><map znear='0.05' zfar='10'/></visual><asset>"
         "<material name='white' emission='1' rgba='.85 .85 .85 1'/>"
         "<material name='black' emission='1' rgba='.08 .08 .08 1'/></asset><worldbody>"
         "<geom type='box' material='white' size='0.25 0.19 0.005' pos='0 0 -0.005'/>"
      << squares << "</worldbody></mujoco>";
  World world = World::load_file(file.string());
  std::filesystem::remove(file);
  return world;
}

/// A left camera before the board that looks at one of its points, from aside.
slam::Pose T_world_left(int view) {
  const double around = 2.4 * view, aside = (15 + 20 * (view % 3) / 2.0) * std::numbers::pi / 180;
  const double distance_m = 0.55 + 0.05 * (view % 5);
  const Eigen::Vector3d target(0.09 * std::cos(1.7 * view), 0.07 * std::sin(1.3 * view), 0);
  const Eigen::Vector3d back(std::sin(aside) * std::cos(around), std::sin(aside) * std::sin(around),
                             std::cos(aside));
  slam::Pose T = slam::Pose::Identity();
  T.translation() = target + distance_m * back + Eigen::Vector3d(-0.04, 0, 0);
  const Eigen::Vector3d z = -back, x = Eigen::Vector3d::UnitY().cross(z).normalized() * -1;
  T.linear() << x, z.cross(x), z;
  return T;
}

/// Corners in the raw images of both cameras.
class BoardViews {
 public:
  explicit BoardViews(const HeadModel& head) : head_(head), world_(board()) {
    const RawCamera left(*head.raw, head.width_px, head.height_px, 0);
    const RawCamera right(*head.raw, head.width_px, head.height_px, 1);
    Renderer renderer(world_, left.view().size.width, left.view().size.height,
                      {.antialiasing = 4, .reflections = false, .shadows = false});
    const World::DataPtr state = world_.make_data();
    mj_kinematics(&world_.model(), state.get());
    renderer.update_scene(*state);
    for (int view = 0; view < kViews; ++view) {
      View corners = {seen(left, T_world_left(view), view, renderer),
                      seen(right, T_world_left(view) * head.T_left_right(), view, renderer)};
      if (!corners[0].empty() && !corners[1].empty()) views.push_back(std::move(corners));
    }
  }

  std::vector<View> views;

 private:
  Corners seen(const RawCamera& camera, const slam::Pose& T_world_camera, int frame,
               Renderer& renderer) const {
    cv::Mat rendered, level, image;
    const RenderView& view = camera.view();
    renderer.render_grey({view.focal_px, view.cx_px, view.cy_px, T_world_camera}, rendered);
    camera.see(rendered, level);
    camera.read_out(level, {head_.raw->exposure.time_s, head_.raw->exposure.gain_db}, kSeed, frame, image);
    Corners corners;
    if (!cv::findChessboardCorners(image, kCorners, corners)) return {};
    cv::cornerSubPix(image, corners, {5, 5}, {-1, -1},
                     {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 60, 1e-4});
    return corners;
  }

  const HeadModel& head_;
  World world_;
};

std::vector<cv::Point3f> board_points() {
  std::vector<cv::Point3f> points;
  for (int row = 0; row < kCorners.height; ++row) {
    for (int col = 0; col < kCorners.width; ++col) {
      points.emplace_back(static_cast<float>(col * kSquare_m), static_cast<float>(row * kSquare_m), 0.0F);
    }
  }
  return points;
}

/// One camera's calibration with its standard deviations: fx, fy, cx, cy, k1, k2, p1, p2, k3.
struct Calibration {
  cv::Mat M, D, deviations;
  std::vector<cv::Mat> rvecs, tvecs;
  double rms_px = 0;
};

Calibration calibrated(const std::vector<View>& views, size_t camera, cv::Size size) {
  Calibration c;
  std::vector<Corners> corners;
  for (const View& view : views) corners.push_back(view[camera]);
  const std::vector<std::vector<cv::Point3f>> points(views.size(), board_points());
  cv::Mat view_deviations, view_errors;
  c.rms_px = cv::calibrateCamera(points, corners, size, c.M, c.D, c.rvecs, c.tvecs, c.deviations,
                                 view_deviations, view_errors);
  return c;
}

void expect_lens(const Calibration& found, const Lens& lens) {
  const std::array<const char*, 9> names = {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"};
  const std::array<double, 9> truth = {lens.fx_px, lens.fy_px, lens.cx_px, lens.cy_px, lens.k1,
                                       lens.k2,    lens.p1,    lens.p2,    lens.k3};
  const std::array<double, 9> value = {
      found.M.at<double>(0, 0), found.M.at<double>(1, 1), found.M.at<double>(0, 2),
      found.M.at<double>(1, 2), found.D.at<double>(0),    found.D.at<double>(1),
      found.D.at<double>(2),    found.D.at<double>(3),    found.D.at<double>(4)};
  for (int i = 0; i < 9; ++i) {
    const auto n = static_cast<size_t>(i);
    const double deviation = found.deviations.at<double>(i);
    EXPECT_NEAR(value[n], truth[n], 3 * deviation) << names[n];
  }
  // the deviations are small enough to mean something: a focal length to 0.1 %
  EXPECT_LT(found.deviations.at<double>(0), 1e-3 * lens.fx_px);
}

/// The joint estimate of a stereo calibration: both lenses, the right camera's place, and the board's in
/// every view. Columns of its Jacobian: 9 + 9 + 6 + 6 a view.
class JointEstimate {
 public:
  JointEstimate(const Calibration& left, const Calibration& right, const cv::Mat& R, const cv::Mat& T) {
    add_lens(left);
    add_lens(right);
    cv::Mat r;
    cv::Rodrigues(R, r);
    add(r), add(T);
    for (size_t i = 0; i < left.rvecs.size(); ++i) add(left.rvecs[i]), add(left.tvecs[i]);
  }

  /// Standard deviation of the baseline: of T's length, from the residuals' rms.
  double baseline_deviation_m(const std::vector<View>& views) const {
    const Eigen::VectorXd at =
        Eigen::Map<const Eigen::VectorXd>(p_.data(), static_cast<Eigen::Index>(p_.size()));
    const Eigen::VectorXd r = residuals(at, views);
    Eigen::MatrixXd J(r.size(), at.size());
    for (Eigen::Index i = 0; i < at.size(); ++i) {
      const double step = 1e-6 * std::max(1.0, std::abs(at[i]));
      Eigen::VectorXd beside = at;
      beside[i] += step;
      J.col(i) = (residuals(beside, views) - r) / step;
    }
    const double variance = r.squaredNorm() / static_cast<double>(r.size() - at.size());
    const Eigen::MatrixXd covariance = variance * (J.transpose() * J).inverse();
    const Eigen::Vector3d T = at.segment<3>(21);
    const Eigen::Matrix3d of_T = covariance.block<3, 3>(21, 21);
    return std::sqrt(T.normalized().dot(of_T * T.normalized()));
  }

 private:
  void add(const cv::Mat& values) {
    for (int i = 0; i < static_cast<int>(values.total()); ++i) p_.push_back(values.at<double>(i));
  }
  void add_lens(const Calibration& c) {
    for (const auto& [row, col] : {std::pair(0, 0), std::pair(1, 1), std::pair(0, 2), std::pair(1, 2)}) {
      p_.push_back(c.M.at<double>(row, col));
    }
    add(c.D.colRange(0, 5));
  }
  static Eigen::VectorXd residuals(const Eigen::VectorXd& p, const std::vector<View>& views) {
    std::vector<cv::Point3d> points;  // in double: for differences
    for (const cv::Point3f& p_board : board_points()) points.emplace_back(p_board);
    Eigen::VectorXd r(static_cast<Eigen::Index>(4 * points.size() * views.size()));
    Eigen::Index next = 0;
    const auto vec = [&p](Eigen::Index at) { return cv::Vec3d(p[at], p[at + 1], p[at + 2]); };
    for (size_t v = 0; v < views.size(); ++v) {
      const auto board = static_cast<Eigen::Index>(24 + 6 * v);
      for (Eigen::Index camera = 0; camera < 2; ++camera) {
        cv::Vec3d rvec = vec(board), tvec = vec(board + 3);
        if (camera == 1) cv::composeRT(cv::Vec3d(rvec), cv::Vec3d(tvec), vec(18), vec(21), rvec, tvec);
        const double* lens = p.data() + 9 * camera;
        const cv::Matx33d M(lens[0], 0, lens[2], 0, lens[1], lens[3], 0, 0, 1);
        std::vector<cv::Point2d> uv;
        cv::projectPoints(points, rvec, tvec, M, std::vector<double>(lens + 4, lens + 9), uv);
        for (size_t i = 0; i < points.size(); ++i) {
          const cv::Point2f seen = views[v][static_cast<size_t>(camera)][i];
          r[next++] = uv[i].x - seen.x;
          r[next++] = uv[i].y - seen.y;
        }
      }
    }
    return r;
  }

  std::vector<double> p_;
};

TEST(Checkerboard, GivesBackLensesAndBaseline) {
  HeadModel head = load_head("models/heads/sth_mdcs_raw.yaml");
  head.raw->exposure.automatic.reset();
  head.raw->exposure.sub_frames = 1;
  head.raw->exposure.readout_s = 0;
  const BoardViews board(head);
  ASSERT_GE(board.views.size(), 12U) << "views in which both cameras see the whole board";
  const cv::Size size(head.width_px, head.height_px);
  Calibration left = calibrated(board.views, 0, size), right = calibrated(board.views, 1, size);
  EXPECT_LT(left.rms_px, 0.15);
  EXPECT_LT(right.rms_px, 0.15);
  expect_lens(left, head.raw->optics.left);
  expect_lens(right, head.raw->optics.right);

  std::array<std::vector<Corners>, 2> corners;
  for (const View& view : board.views) {
    for (const size_t camera : {0, 1}) corners[camera].push_back(view[camera]);
  }
  const std::vector<std::vector<cv::Point3f>> points(board.views.size(), board_points());
  cv::Mat R, T, E, F;
  cv::stereoCalibrate(points, corners[0], corners[1], left.M, left.D, right.M, right.D, size, R, T, E, F,
                      cv::CALIB_USE_INTRINSIC_GUESS,
                      {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 60, 1e-9});
  const double deviation_m = JointEstimate(left, right, R, T).baseline_deviation_m(board.views);
  const double baseline_m = head.T_left_right().translation().norm();
  EXPECT_NEAR(cv::norm(T), baseline_m, 3 * deviation_m);
  EXPECT_LT(deviation_m, 2e-3 * baseline_m);
}

}  // namespace
}  // namespace groundloop::sim
