#pragma once

#include <cstddef>

namespace tyndall
{
// A cycle of multigrid that preconditions conjugate gradients, in one memory (MultigridSolver.h) and over ranks
// (Distributed/Balance/MultigridOverRanks.h).

constexpr int FinishRounds = 12; ///< on the coarsest level
constexpr float Damping = 0.87f; ///< of Jacobi's method, about the best: 0.8 takes 8% more iterations, 0.95 as many
constexpr std::size_t VisitedTwice = 2; ///< coarser levels, the finest of them: more visits save no iterations
/// Of what each of two visits finds that is taken: so that two of them stay positive where one overshoots up to 2.5
/// times, which joined voxels of unequal ones make it do.
constexpr float PartOfVisit = 0.8f;
}
