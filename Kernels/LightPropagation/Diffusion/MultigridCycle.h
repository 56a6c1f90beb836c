#pragma once

#include <cstddef>

namespace tyndall
{
// Parameters of the multigrid cycle that preconditions conjugate gradients, serial (MultigridSolver.h) and over ranks
// (MultigridOverRanks.h).

constexpr int FinishRounds = 12; ///< symmetric Gauss-Seidel iterations on the coarsest level
/// Damping of Jacobi's method, about the optimum: 0.8 takes 8% more iterations, 0.95 as many.
constexpr float Damping = 0.87f;
/// Number of coarse levels, from the finest of them, that are visited twice per cycle; more do not save iterations.
constexpr std::size_t VisitedTwice = 2;
/// Fraction of each of two visits' correction that is applied. With it the preconditioner stays positive even if one
/// visit overshoots by up to a factor of 2.5, as it does where voxels of unequal coefficients are joined.
constexpr float PartOfVisit = 0.8f;
}
