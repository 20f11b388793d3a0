// SPDX-License-Identifier: Apache-2.0
/// \file
/// Decompositions of dense matrices of any size. Eigen's templates of these take a compiler up to half a minute each: they are
/// compiled once, here.
#pragma once

#include <Eigen/Core>

namespace spindrift::dense {

/// Of a real square matrix, n x n: n values, vectors as columns of length 1 (Eigen's EigenSolver).
struct Eigenpairs {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;
};
Eigenpairs eigenpairs(const Eigen::MatrixXd& matrix);
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix);

/// exp of a square matrix, by scaling and squaring of a Pade approximant.
Eigen::MatrixXd exponential(const Eigen::MatrixXd& matrix);

/// Of a symmetric matrix, values from the lowest up, vectors as columns; only the lower half is read.
struct SymmetricEigenpairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
SymmetricEigenpairs symmetric_eigenpairs(const Eigen::MatrixXd& matrix);
/// `stiffness` v = value `mass` v, both symmetric, `mass` positive definite; v^T mass v = 1.
SymmetricEigenpairs symmetric_eigenpairs(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass);

/// matrix = left diag(values) right^T; values from the largest down, min(rows, columns) of them and of the columns of both.
struct SingularValues {
  Eigen::VectorXd values;
  Eigen::MatrixXd left, right;
};
/// By two-sided Jacobi rotations: small values have as many digits as large ones.
SingularValues singular_values(const Eigen::MatrixXd& matrix);

/// x of matrix x = right; LU with partial pivoting.
Eigen::VectorXd solve(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);
/// x of least |matrix x - right|; QR with pivoting of columns.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);
Eigen::MatrixXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);

}  // namespace spindrift::dense
