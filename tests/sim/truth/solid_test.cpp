#include "sim/truth/solid.h"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/truth/bullet.h"

namespace groundloop::sim {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

OrientedBox cube(const Vector3d& centre, double half) {
  return {centre, Matrix3d::Identity(), Vector3d::Constant(half)};
}

void expect_hit(const Solid& solid, const Vector3d& origin, const Vector3d& direction, double t,
                const Vector3d& normal) {
  const auto hit = solid.first_hit(origin, direction, 100);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->t, t, 1e-12);
  EXPECT_NEAR((hit->normal - normal).norm(), 0, 1e-12) << hit->normal.transpose();
}

TEST(Box, RayMeetsTheFaceItFaces) {
  const auto box = make_box({1, 2, 3});
  expect_hit(*box, {5, 0, 0}, {-1, 0, 0}, 4, {1, 0, 0});
  expect_hit(*box, {0, 0, -10}, {0, 0, 2}, 3.5, {0, 0, -1});
  expect_hit(*box, {0, 0, 0}, {0, 1, 0}, 2, {0, -1, 0});  // from inside
  expect_hit(*box, {4, 5, 0}, {-1, -1, 0}, 3,
             Vector3d(1, 1, 0).cwiseProduct(Vector3d(1, 0, 0)));  // along an edge
  EXPECT_FALSE(box->first_hit({5, 0, 0}, {1, 0, 0}, 100));
  EXPECT_FALSE(box->first_hit({5, 0, 0}, {-1, 0, 0}, 3.999));
  EXPECT_FALSE(box->first_hit({5, 2.001, 0}, {-1, 0, 0}, 100));
}

TEST(Box, WithoutThicknessIsARectangleSeenFromBothSides) {
  const auto plane = make_box({1, 1, 0});
  expect_hit(*plane, {0.5, 0.5, 2}, {0, 0, -1}, 2, {0, 0, 1});
  expect_hit(*plane, {0.5, 0.5, -2}, {0, 0, 1}, 2, {0, 0, -1});
  EXPECT_FALSE(plane->first_hit({1.001, 0, 2}, {0, 0, -1}, 100));
  EXPECT_TRUE(plane->reaches_into(cube({0, 0, 0.4}, 0.5)));
  EXPECT_FALSE(plane->reaches_into(cube({0, 0, 0.6}, 0.5)));
}

TEST(Ellipsoid, RayMeetsTheQuadric) {
  const auto ball = make_ellipsoid({2, 2, 2});
  // 3-4-5: at height 1.2 the chord's half length is 1.6
  expect_hit(*ball, {5, 0, 1.2}, {-1, 0, 0}, 3.4, Vector3d(1.6, 0, 1.2) / 2);
  const auto egg = make_ellipsoid({1, 2, 3});
  expect_hit(*egg, {0, 0, 7}, {0, 0, -1}, 4, {0, 0, 1});
  expect_hit(*egg, {0, 0, 0}, {0, -1, 0}, 2, {0, 1, 0});
  // on x = 0.6: z = 3 * 0.8; gradient (0.6, 0, 2.4 / 9)
  expect_hit(*egg, {0.6, 0, 10}, {0, 0, -1}, 7.6, Vector3d(0.6, 0, 2.4 / 9).normalized());
  EXPECT_FALSE(egg->first_hit({1.001, 0, 10}, {0, 0, -1}, 100));
}

TEST(Capsule, RayMeetsWallAndDomes) {
  const auto capsule = make_capsule(0.5, 1);
  expect_hit(*capsule, {3, 0, 0.9}, {-1, 0, 0}, 2.5, {1, 0, 0});
  expect_hit(*capsule, {0, 0, 5}, {0, 0, -1}, 3.5, {0, 0, 1});
  // dome at height 1.3: chord half length 0.4
  expect_hit(*capsule, {3, 0, 1.3}, {-1, 0, 0}, 2.6, Vector3d(0.8, 0, 0.6));
  expect_hit(*capsule, {0, 0, 0}, {0, 0, 1}, 1.5, {0, 0, -1});
  EXPECT_FALSE(capsule->first_hit({3, 0, 1.501}, {-1, 0, 0}, 100));
}

TEST(Cylinder, RayMeetsWallAndCaps) {
  const auto cylinder = make_cylinder(0.5, 1);
  expect_hit(*cylinder, {3, 0.3, 0.9}, {-1, 0, 0}, 2.6, Vector3d(0.8, 0.6, 0));
  expect_hit(*cylinder, {0.2, 0.2, 5}, {0, 0, -1}, 4, {0, 0, 1});
  expect_hit(*cylinder, {0, 0, 0}, {0, 0, 1}, 1, {0, 0, -1});
  expect_hit(*cylinder, {0, 0, 0}, {-1, 0, 0}, 0.5, {1, 0, 0});
  EXPECT_FALSE(cylinder->first_hit({3, 0, 1.001}, {-1, 0, 0}, 100));
  EXPECT_FALSE(cylinder->first_hit({0.51, 0, 5}, {0, 0, -1}, 100));
}

Triangles tetrahedron() {
  Triangles out;
  out.vertices.resize(3, 4);
  out.vertices << 0, 1, 0, 0,  //
      0, 0, 1, 0,              //
      0, 0, 0, 1;
  out.corners.resize(3, 4);
  out.corners << 0, 0, 0, 1,  //
      2, 1, 3, 2,             //
      1, 3, 2, 3;
  return out;
}

TEST(TriangleMesh, RayMeetsTheTriangles) {
  const auto mesh = make_triangles(tetrahedron());
  // x + y + z = 1 at (0.2, 0.3)
  expect_hit(*mesh, {0.2, 0.3, 5}, {0, 0, -1}, 4.5, Vector3d(1, 1, 1).normalized());
  expect_hit(*mesh, {0.2, 0.3, -5}, {0, 0, 2}, 2.5, {0, 0, -1});
  EXPECT_FALSE(mesh->first_hit({0.6, 0.6, 5}, {0, 0, -1}, 100));
  EXPECT_FALSE(mesh->first_hit({0.2, 0.3, 5}, {0, 0, -1}, 4.4));
}

TEST(TriangleMesh, ReachesIntoBoxesItsSurfaceCrosses) {
  const auto mesh = make_triangles(tetrahedron());
  EXPECT_TRUE(mesh->reaches_into(cube({0.4, 0.4, 0.4}, 0.1)));      // corner (0.3, 0.3, 0.3) is inside
  EXPECT_FALSE(mesh->reaches_into(cube({0.4, 0.4, 0.4}, 0.06)));    // corner (0.34, 0.34, 0.34) is outside
  EXPECT_FALSE(mesh->reaches_into(cube({0.15, 0.15, 0.15}, 0.1)));  // wholly inside: no surface
  EXPECT_TRUE(mesh->reaches_into(cube({-0.5, -0.5, 1}, 0.501)));    // just takes in the edge x = y = 0
}

TEST(Solids, TouchingFromOutsideDoesNotReachInto) {
  const double gap = 1e-6;
  const auto check = [&](const Solid& solid, const Vector3d& tip, const Vector3d& outward) {
    // tip is a point of the surface whose tangent plane is a plane of coordinates
    EXPECT_FALSE(solid.reaches_into(cube(tip + (0.3 + gap) * outward, 0.3)));
    EXPECT_TRUE(solid.reaches_into(cube(tip + (0.3 - gap) * outward, 0.3)));
  };
  check(*make_box({1, 2, 3}), {1, 0, 0}, {1, 0, 0});
  check(*make_ellipsoid({1, 2, 3}), {0, 2, 0}, {0, 1, 0});
  check(*make_capsule(0.5, 1), {0, 0, 1.5}, {0, 0, 1});
  check(*make_capsule(0.5, 1), {0, 0.5, 0}, {0, 1, 0});
  check(*make_cylinder(0.5, 1), {0, 0, -1}, {0, 0, -1});
  check(*make_cylinder(0.5, 1), {-0.5, 0, 0.2}, {-1, 0, 0});
}

// A corner of the box against a curved surface, where a box of the same extent would already touch.
TEST(Solids, CornerOfTheBoxDecidesAtRoundings) {
  const Vector3d diagonal = Vector3d::Ones() / std::sqrt(3.0);
  const auto ball = make_ellipsoid(Vector3d::Ones());
  EXPECT_FALSE(ball->reaches_into(cube((1 + 1e-6) * diagonal + Vector3d::Constant(0.3), 0.3)));
  EXPECT_TRUE(ball->reaches_into(cube((1 - 1e-6) * diagonal + Vector3d::Constant(0.3), 0.3)));
  const Vector3d across = Vector3d(1, 1, 0) / std::sqrt(2.0);
  const auto cylinder = make_cylinder(1, 5);
  EXPECT_FALSE(cylinder->reaches_into(cube((1 + 1e-6) * across + Vector3d::Constant(0.3), 0.3)));
  EXPECT_TRUE(cylinder->reaches_into(cube((1 - 1e-6) * across + Vector3d::Constant(0.3), 0.3)));
  const auto capsule = make_capsule(1, 5);
  const Vector3d end(0, 0, 5);
  EXPECT_FALSE(capsule->reaches_into(cube(end + (1 + 1e-6) * diagonal + Vector3d::Constant(0.3), 0.3)));
  EXPECT_TRUE(capsule->reaches_into(cube(end + (1 - 1e-6) * diagonal + Vector3d::Constant(0.3), 0.3)));
}

/// Distance by Bullet's GJK on Bullet's own shapes; 0 when they overlap.
double bullet_distance(const btConvexShape& shape, const OrientedBox& box) {
  btBoxShape other(to_bullet(box.half));
  other.setMargin(0);
  const Matrix3d& r = box.axes;
  const btTransform at(
      btMatrix3x3(r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2)),
      to_bullet(box.centre));
  btGjkEpaSolver2::sResults result;
  const bool apart = btGjkEpaSolver2::Distance(&shape, btTransform::getIdentity(), &other, at,
                                               to_bullet(-box.centre), result);
  return apart ? result.distance : 0;
}

/// Boxes of random place, turn and size, near the unit body.
template <class Check>
void for_random_boxes(const Check& check) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> in(-1, 1);
  for (int i = 0; i < 4000; ++i) {
    const Vector3d axis = Vector3d(in(random), in(random), in(random)).normalized();
    const Matrix3d axes = Eigen::AngleAxisd(3 * in(random), axis).toRotationMatrix();
    const Vector3d half =
        Vector3d(in(random), in(random), in(random)).cwiseAbs() * 0.6 + Vector3d::Constant(0.01);
    check(OrientedBox{2 * Vector3d(in(random), in(random), in(random)), axes, half});
  }
}

// Two implementations that share no code: ours is closed-form, Bullet's iterates.
TEST(Solids, OverlapAgreesWithBulletsGjk) {
  btBoxShape box(btVector3(0.5, 0.7, 0.9));
  box.setMargin(0);
  btCylinderShapeZ cylinder(btVector3(0.6, 0.6, 0.8));
  cylinder.setMargin(0);
  const btCapsuleShapeZ capsule(0.4, 1.2);  // its GJK sees the segment; the radius comes on top
  const auto our_box = make_box({0.5, 0.7, 0.9});
  const auto our_cylinder = make_cylinder(0.6, 0.8);
  const auto our_capsule = make_capsule(0.4, 0.6);
  int meeting = 0, apart = 0;
  for_random_boxes([&](const OrientedBox& query) {
    const double to_box = bullet_distance(box, query);
    const double to_cylinder = bullet_distance(cylinder, query);
    const double to_capsule = bullet_distance(capsule, query) - 0.4;
    EXPECT_EQ(our_box->reaches_into(query), to_box <= 0) << to_box;
    EXPECT_EQ(our_cylinder->reaches_into(query), to_cylinder <= 0) << to_cylinder;
    EXPECT_EQ(our_capsule->reaches_into(query), to_capsule <= 0) << to_capsule;
    (to_cylinder <= 0 ? meeting : apart) += 1;
  });
  EXPECT_GT(meeting, 300);
  EXPECT_GT(apart, 300);
}

// Bullet has no ellipsoid; the nearest point of a box in the ellipsoid's metric is found by projected
// descent.
TEST(Solids, EllipsoidOverlapAgreesWithDescent) {
  const Vector3d radii(0.5, 0.8, 1.1);
  const auto egg = make_ellipsoid(radii);
  int meeting = 0;
  for_random_boxes([&](const OrientedBox& box) {
    const Matrix3d a = radii.cwiseInverse().asDiagonal() * box.axes;
    const Vector3d c = radii.cwiseInverse().cwiseProduct(box.centre);
    const double step = 1 / (a.transpose() * a).trace();
    Vector3d u = Vector3d::Zero();
    for (int i = 0; i < 400; ++i) {
      u -= step * (a.transpose() * (c + a * u));
      u = u.cwiseMax(-box.half).cwiseMin(box.half);
    }
    const double nearest = (c + a * u).norm();
    if (std::abs(nearest - 1) < 1e-9) return;
    EXPECT_EQ(egg->reaches_into(box), nearest < 1) << nearest;
    meeting += nearest < 1;
  });
  EXPECT_GT(meeting, 300);
}

TEST(Solids, SupportIsTheFarthestPoint) {
  const Vector3d direction = Vector3d(2, -3, 6) / 7;
  EXPECT_NEAR((make_box({1, 2, 3})->support(direction) - Vector3d(1, -2, 3)).norm(), 0, 1e-12);
  EXPECT_NEAR((make_ellipsoid({2, 2, 2})->support(direction) - 2 * direction).norm(), 0, 1e-12);
  EXPECT_NEAR((make_capsule(0.5, 1)->support(direction) - Vector3d(0, 0, 1) - 0.5 * direction).norm(), 0,
              1e-12);
  const Vector3d rim = Vector3d(2, -3, 0) / std::sqrt(13.0) * 0.5 + Vector3d(0, 0, 1);
  EXPECT_NEAR((make_cylinder(0.5, 1)->support(direction) - rim).norm(), 0, 1e-12);
  EXPECT_NEAR((make_triangles(tetrahedron())->support(direction) - Vector3d(0, 0, 1)).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace groundloop::sim
