#include "models/textures/textures.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <set>
#include <string>

namespace groundloop::textures {
namespace {

TEST(Textures, DrawnTwiceTheSameBytes) {
  for (const Texture& texture : all_textures()) {
    const cv::Mat once = texture.draw(texture.key), again = texture.draw(texture.key);
    ASSERT_EQ(once.type(), CV_8UC3) << texture.name;
    EXPECT_EQ(cv::norm(once, again, cv::NORM_INF), 0) << texture.name;
    cv::Mat burnt_out;
    cv::inRange(once, cv::Scalar(254, 254, 254), cv::Scalar(255, 255, 255), burnt_out);
    EXPECT_LT(cv::countNonZero(burnt_out), 0.01 * once.total()) << texture.name;
  }
}

TEST(Textures, BuildLeftEveryOneOfThem) {
  std::set<std::string> names;
  for (const Texture& texture : all_textures()) {
    EXPECT_TRUE(names.insert(texture.name).second) << texture.name << " is there twice";
    const std::string file = std::string("models/generated/") + texture.name + ".png";
    const cv::Mat built = cv::imread(file, cv::IMREAD_COLOR);
    ASSERT_FALSE(built.empty()) << file;
    EXPECT_EQ(cv::norm(built, texture.draw(texture.key), cv::NORM_INF), 0) << file;
  }
}

}  // namespace
}  // namespace groundloop::textures
