#pragma once

/// @file constrained_minimiser.h
/// Least squares under conditions of any rank, by dense matrices.

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <Eigen/SVD>
#include <vector>

namespace tribound::test
{

/// A linear form in the unknowns of a patch, and the value that it should have.
struct Row
{
  Eigen::VectorXd form;
  double value;
};

inline Eigen::MatrixXd stacked(const std::vector<Row>& rows)
{
  Eigen::MatrixXd matrix(rows.size(), rows[0].form.size());
  for (std::size_t i = 0; i < rows.size(); ++i) matrix.row(i) = rows[i].form.transpose();
  return matrix;
}

inline Eigen::VectorXd stacked_values(const std::vector<Row>& rows)
{
  Eigen::VectorXd values(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) values[i] = rows[i].value;
  return values;
}

/// x with |A x - b| -> min under C x = d, C of any rank.
inline Eigen::VectorXd constrained_minimiser(const std::vector<Row>& squares,
                                             const std::vector<Row>& constraints)
{
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(stacked(constraints),
                                              Eigen::ComputeThinU | Eigen::ComputeFullV);
  const Eigen::VectorXd s = svd.singularValues();
  const Eigen::Index rank = (s.array() > 1e-10 * s[0]).count();
  const Eigen::VectorXd d = svd.matrixU().leftCols(rank).transpose() * stacked_values(constraints);
  const Eigen::VectorXd x = svd.matrixV().leftCols(rank) * (d.array() / s.head(rank).array()).matrix();
  EXPECT_LE((stacked(constraints) * x - stacked_values(constraints)).norm(),
            1e-10 * (1 + stacked_values(constraints).norm()));
  const Eigen::MatrixXd free = svd.matrixV().rightCols(svd.matrixV().cols() - rank);
  const Eigen::MatrixXd a = stacked(squares) * free;
  const Eigen::VectorXd rest = stacked_values(squares) - stacked(squares) * x;
  return free.cols() == 0 ? x : x + free * a.colPivHouseholderQr().solve(rest);
}

}  // namespace tribound::test
