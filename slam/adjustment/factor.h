#pragma once

#include <Eigen/Cholesky>

namespace groundloop::slam {

using LowerFactor = Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>>;

constexpr double kLeastPivot = 1e-8;  ///< of a matrix that is not singular, see regular()

/// Whether a Cholesky factor L of H = L L^T is that of a matrix far from singular: what is left of each
/// unknown when those before it are known no longer is a fair part of what is known of it given all others.
template <class Factor, class Diagonal>
bool regular(const Factor& L, const Diagonal& diagonal) {
  return (L.diagonal().array().square() > kLeastPivot * diagonal.array()).all();
}

/// Inverse of a 3x3 information matrix; false when it is singular.
inline bool invert(const Eigen::Matrix3d& H, Eigen::Matrix3d& inverse) {
  const Eigen::LLT<Eigen::Matrix3d> llt(H);
  if (llt.info() != Eigen::Success || !regular(llt.matrixLLT(), H.diagonal())) return false;
  inverse = llt.solve(Eigen::Matrix3d::Identity());
  return true;
}

}  // namespace groundloop::slam
