// The extreme matrix: scenes at the edge of what numbers can hold, through every solver's filters. Each cell is right,
// by all that is known of its light without solving it (balance, furnaces, symmetry, scale, closed forms), or it is
// refused with one clear error, or it is WRONG: not a number, negative, wrong, crashed or hung. Exit status 1 where one
// is.
//
//   TyndallBenchStress [--quick] [part of a row's, case's or method's name]...

#include "Arguments.h"
#include "Report.h"
#include "StressChecks.h"
#include "StressWorker.h"

#include "../Filters/TestSupport.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>

using namespace bench;

namespace
{
constexpr double TimeLimit = 300.0; ///< seconds of a cell that then hangs, kernels to compile included

struct Cell
{
  const StressCase* stressCase;
  StressSolver solver;
};

std::string GridOf(const StressScene& scene)
{
  return std::to_string(scene.cells[0]) + "x" + std::to_string(scene.cells[1]) + "x" + std::to_string(scene.cells[2]);
}

JsonLine LineOf(const Cell& cell)
{
  return JsonLine()
    .Add("bench", "stress")
    .Add("row", cell.stressCase->row)
    .Add("case", cell.stressCase->row + ": " + cell.stressCase->name)
    .Add("method", NameOf(cell.solver))
    .Add("grid", GridOf(cell.stressCase->scene));
}

/// Runs a cell and prints its line.
/// @return its verdict
std::string RunCell(const Cell& cell)
{
  const StressOutcome outcome = RunStress(cell.solver, cell.stressCase->scene);
  JsonLine line = LineOf(cell);
  line.Add("seconds", outcome.seconds);
  if (!outcome.errors.empty())
  {
    const bool clear =
      outcome.errors.size() == 1 && outcome.empty && MayRefuse(cell.solver, *cell.stressCase, outcome.errors[0]);
    const std::string verdict = clear ? "refused" : "WRONG";
    line.Add("verdict", verdict).Add("errors", static_cast<double>(outcome.errors.size()));
    line.Add("error", outcome.errors[0]).Print();
    return verdict;
  }
  StressOutcome twin;
  if (cell.stressCase->twin && !IsView(cell.solver))
  {
    twin = RunStress(cell.solver, *cell.stressCase->twin);
  }
  std::vector<StressCheck> checks =
    CheckOutcome(cell.solver, *cell.stressCase, outcome, cell.stressCase->twin ? &twin : nullptr);
  if (IsGrid(cell.solver))
  {
    // Each cell in one of the cube's 47 other ways to lie; all of them occur many times.
    static const std::vector<CubeTurn> turns = AllCubeTurns();
    const CubeTurn& turn = turns[1 + std::hash<std::string>()(cell.stressCase->row + cell.stressCase->name) % 47];
    const StressScene& scene = cell.stressCase->scene;
    const StressOutcome turned = RunStress(cell.solver, Turned(scene, turn), StressTightTolerance);
    const StressOutcome first =
      EndsByTolerance(cell.solver) ? RunStress(cell.solver, scene, StressTightTolerance) : outcome;
    checks.push_back(CheckTurned(*cell.stressCase, first, turn, turned));
  }
  std::string failed;
  for (const StressCheck& check : checks)
  {
    failed += check.Holds() ? "" : (failed.empty() ? "" : ", ") + check.name;
  }
  const std::string verdict = failed.empty() ? "right" : "WRONG";
  line.Add("verdict", verdict);
  if (!failed.empty())
  {
    line.Add("failed", failed);
  }
  for (const StressCheck& check : checks)
  {
    line.Add(check.name.c_str(), check.value).Add((check.name + "_at_most").c_str(), check.atMost);
  }
  if (!outcome.warnings.empty())
  {
    line.Add("warning", outcome.warnings[0]);
  }
  line.Print();
  return verdict;
}

std::vector<Cell> CellsOf(const std::vector<StressCase>& cases, bool quick, const std::vector<std::string>& words)
{
  std::vector<Cell> cells;
  for (const StressCase& one : cases)
  {
    for (int solver = 0; solver < static_cast<int>(StressSolver::Count); ++solver)
    {
      const Cell cell = { &one, static_cast<StressSolver>(solver) };
      const std::string name = one.row + ": " + one.name + " / " + NameOf(cell.solver) + " /";
      const bool asked = std::all_of(
        words.begin(), words.end(), [&](const std::string& word) { return name.find(word) != std::string::npos; });
      if (asked && (one.quick || !quick) && Concerns(cell.solver, one))
      {
        cells.push_back(cell);
      }
    }
  }
  return cells;
}

/// Rows by solvers: how many cells are right, refused and WRONG.
void PrintTable(const std::vector<Cell>& cells, const std::vector<std::string>& verdicts)
{
  std::vector<std::string> headings = { "row", "" };
  for (int solver = 0; solver < static_cast<int>(StressSolver::Count); ++solver)
  {
    headings.push_back(NameOf(static_cast<StressSolver>(solver)));
  }
  Table table(headings);
  for (std::size_t first = 0; first < cells.size();)
  {
    const std::string& name = cells[first].stressCase->row;
    std::vector<std::string> row = { name, "" };
    std::size_t end = first;
    while (end < cells.size() && cells[end].stressCase->row == name)
    {
      ++end;
    }
    for (int solver = 0; solver < static_cast<int>(StressSolver::Count); ++solver)
    {
      int right = 0, refused = 0, wrong = 0;
      for (std::size_t i = first; i < end; ++i)
      {
        if (static_cast<int>(cells[i].solver) == solver)
        {
          ++(verdicts[i] == "right" ? right : verdicts[i] == "refused" ? refused : wrong);
        }
      }
      std::string text = right > 0 ? std::to_string(right) + " right" : "";
      text += refused > 0 ? (text.empty() ? "" : ", ") + std::to_string(refused) + " refused" : "";
      text += wrong > 0 ? (text.empty() ? "" : ", ") + std::to_string(wrong) + " WRONG" : "";
      row.push_back(text.empty() ? "-" : text);
    }
    table.Add(row);
    first = end;
  }
  table.Print("The extreme matrix: cells right, refused with a clear error, WRONG");
}
}

int main(int argc, char* argv[])
{
  const bench::Arguments arguments = bench::ReadArguments(argc, argv);
  // Not asked here: a process that has used OpenCL cannot be forked.
  if (RunApart([] { return test::ThereIsADevice() ? 0 : 1; }, TimeLimit) != 0)
  {
    std::fprintf(stderr, "There is no OpenCL device.\n");
    return std::getenv("TYNDALL_REQUIRE_DEVICE") ? EXIT_FAILURE : 125;
  }
  const std::vector<StressCase> cases = StressCases();
  const std::vector<Cell> cells = CellsOf(cases, arguments.quick, arguments.words);
  const std::vector<std::string> verdicts = RunAllApart(
    cells.size(), TimeLimit, [&](std::size_t i) { return RunCell(cells[i]); },
    [&](std::size_t i, const std::string& death) {
      LineOf(cells[i]).Add("verdict", "WRONG").Add("failed", death).Print();
    });
  PrintTable(cells, verdicts);
  const auto wrong = std::count(verdicts.begin(), verdicts.end(), "WRONG");
  std::printf("\n%zu cells, %td WRONG\n", cells.size(), wrong);
  return wrong == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
