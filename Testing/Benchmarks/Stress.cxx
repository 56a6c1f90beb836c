// The extreme matrix: scenes at the edge of what numbers can hold, through every solver's filters. Each cell is right,
// by all that is known of its light without solving it (balance, furnaces, symmetry, scale, closed forms), or it is
// refused with one clear error, or it is WRONG: not a number, negative, wrong, crashed or hung. Exit status 1 where one
// is.
//
//   TyndallBenchStress [--quick] [--random SECONDS [--seed N]] [part of a row's, case's or method's name]...
//
// Random cells are those of a seed (of the day by default), one after the other while there is time.

#include "Arguments.h"
#include "Measure.h"
#include "Report.h"
#include "StressChecks.h"
#include "StressWorker.h"

#include "../Filters/TestSupport.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <map>
#include <random>

using namespace bench;

namespace
{
constexpr double TimeLimit = 300.0; ///< seconds of a cell that then hangs, kernels to compile included

struct Cell
{
  const StressCase* stressCase;
  const StressSolver* solver;
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
    .Add("method", cell.solver->name)
    .Add("grid", GridOf(cell.stressCase->scene));
}

std::size_t HashOf(const StressCase& stressCase)
{
  return std::hash<std::string>()(stressCase.row + stressCase.name);
}

/// What the same solver gives for the case's twin, and the rest of its light.
StressOutcome TwinOf(const StressSolver& solver, const StressCase& stressCase)
{
  StressOutcome twin = RunStress(solver, *stressCase.twin);
  if (stressCase.rest)
  {
    const StressOutcome rest = RunStress(solver, *stressCase.rest);
    twin.fluence.resize(std::min(twin.fluence.size(), rest.fluence.size()));
    std::transform(twin.fluence.begin(), twin.fluence.end(), rest.fluence.begin(), twin.fluence.begin(), std::plus<>());
  }
  return twin;
}

/// Numbers that differ between two runs of the same.
double DifferentNumbers(const StressOutcome& a, const StressOutcome& b)
{
  double different = 0.0;
  for (const auto field : { &StressOutcome::fluence, &StressOutcome::fluenceDirect, &StressOutcome::netFlux,
         &StressOutcome::fluenceError, &StressOutcome::directions, &StressOutcome::radiance, &StressOutcome::through })
  {
    const std::vector<float>&x = a.*field, &y = b.*field;
    different += x.size() == y.size() ? 0.0 : 1.0;
    for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i)
    {
      different += x[i] == y[i] ? 0.0 : 1.0;
    }
  }
  return different;
}

/// The light beside that of the turned scene, of a row that is to have the same light, and of the same run again.
void CompareRuns(
  const StressSolver& solver, const StressCase& asked, const StressOutcome& outcome, std::vector<StressCheck>& checks)
{
  static const std::vector<CubeTurn> turns = AllCubeTurns();
  const bool tight = solver.EndsByTolerance();
  const bool turnsToo = solver.IsGrid() && !solver.Is(OfPhotons | Unturned | Preview);
  const double tolerance = tight ? StressTightTolerance : StressTolerance; // residuals are told over it
  const StressOutcome first =
    tight && (turnsToo || !solver.like.empty()) ? RunStress(solver, asked.scene, tolerance) : outcome;
  if (turnsToo)
  {
    // Each cell in one of the cube's 47 other ways to lie; all of them occur many times.
    const CubeTurn& turn = turns[1 + HashOf(asked) % 47];
    const StressOutcome turned = RunStress(solver, Turned(asked.scene, turn), tolerance);
    checks.push_back(CheckTurned(asked, first, turn, turned));
  }
  if (!solver.like.empty())
  {
    const auto like = std::find_if(StressSolvers().begin(), StressSolvers().end(),
      [&](const StressSolver& other) { return other.name == solver.like; });
    const StressOutcome same = RunStress(*like, asked.scene, tolerance);
    if (same.errors.empty()) // filters refuse more than kernels
    {
      checks.push_back(CheckTurned(asked, first, turns[0], same));
      checks.back().name = "as_" + solver.like;
    }
  }
  // Sums of photons as published lose what comes at the same time.
  if (HashOf(asked) % 4 == 0 && !(solver.IsPhotons() && solver.Is(Published)))
  {
    checks.push_back({ "other_bits_again", DifferentNumbers(outcome, RunStress(solver, asked.scene)), 0.0 });
  }
}

/// Whether all errors say the same, as those of filters that refuse the same medium one after the other.
bool AreAlike(const std::vector<std::string>& errors)
{
  const auto words = [](const std::string& error) { return error.substr(std::min(error.find("): "), error.size())); };
  return std::all_of(
    errors.begin(), errors.end(), [&](const std::string& error) { return words(error) == words(errors[0]); });
}

/// Runs a cell and prints its line.
/// @return its verdict
std::string RunCell(const Cell& cell)
{
  const StressSolver& solver = *cell.solver;
  const StressCase asked = CaseFor(solver, *cell.stressCase);
  const StressOutcome outcome = RunStress(solver, asked.scene);
  JsonLine line = LineOf(cell);
  line.Add("seconds", outcome.seconds);
  if (!outcome.errors.empty())
  {
    const bool clear = AreAlike(outcome.errors) && outcome.empty && MayRefuse(solver, asked, outcome.errors[0]);
    const std::string verdict = clear ? "refused" : "WRONG";
    line.Add("verdict", verdict).Add("errors", static_cast<double>(outcome.errors.size()));
    for (std::size_t i = 0; i < outcome.errors.size(); ++i)
    {
      line.Add(i == 0 ? "error" : ("error_" + std::to_string(i + 1)).c_str(), outcome.errors[i]);
    }
    line.Print();
    return verdict;
  }
  const bool hasTwin = asked.twin && !solver.IsView() && !solver.IsStage();
  const StressOutcome twin = hasTwin ? TwinOf(solver, asked) : StressOutcome();
  std::vector<StressCheck> checks = CheckOutcome(solver, asked, outcome, hasTwin ? &twin : nullptr);
  CompareRuns(solver, asked, outcome, checks);
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
    const auto least = [](const auto& values) {
      return values.empty() ? 0.0 : static_cast<double>(*std::min_element(values.begin(), values.end()));
    };
    line.Add("least_of_balance", least(outcome.balance)).Add("least_through_face", least(outcome.facePowerOut));
    line.Add("least_fluence", least(outcome.fluence)).Add("residual_by_tolerance", outcome.residual);
    for (std::size_t i = 0; i < outcome.balance.size(); ++i)
    {
      line.Add(("balance_" + std::to_string(i)).c_str(), outcome.balance[i]);
    }
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
    for (const StressSolver& solver : StressSolvers())
    {
      const Cell cell = { &one, &solver };
      const std::string name = one.row + ": " + one.name + " / " + solver.name + " /";
      const bool asked = std::all_of(
        words.begin(), words.end(), [&](const std::string& word) { return name.find(word) != std::string::npos; });
      if (asked && (one.quick || !quick) && Concerns(solver, one))
      {
        cells.push_back(cell);
      }
    }
  }
  return cells;
}

/// How many cells of each row of the table are right, refused and WRONG.
void PrintTable(const std::vector<Cell>& cells, const std::vector<std::string>& verdicts)
{
  Table table({ "solver", "", "right", "refused", "WRONG" });
  for (const StressSolver& solver : StressSolvers())
  {
    std::map<std::string, int> count;
    for (std::size_t i = 0; i < cells.size(); ++i)
    {
      count[verdicts[i]] += cells[i].solver == &solver ? 1 : 0;
    }
    if (count["right"] + count["refused"] + count["WRONG"] > 0)
    {
      table.Add({ solver.name, "", std::to_string(count["right"]), std::to_string(count["refused"]),
        std::to_string(count["WRONG"]) });
    }
  }
  table.Print("The extreme matrix: cells right, refused with a clear error, WRONG");
}

struct Random
{
  double seconds = 0.0; ///< 0: all cells in their order
  unsigned seed = static_cast<unsigned>(std::time(nullptr) / 86400);
};

/// Takes `--random SECONDS` and `--seed N` out of the words.
Random TakeRandom(std::vector<std::string>& words)
{
  Random random;
  for (auto word = words.begin(); word != words.end();)
  {
    const bool isSeconds = *word == "--random";
    if (!isSeconds && *word != "--seed")
    {
      ++word;
      continue;
    }
    const double value = word + 1 != words.end() ? std::atof((word + 1)->c_str()) : 0.0;
    if (!(value > 0.0))
    {
      std::fprintf(stderr, "%s needs a number above 0.\n", word->c_str());
      std::exit(EXIT_FAILURE);
    }
    random.seconds = isSeconds ? value : random.seconds;
    random.seed = isSeconds ? random.seed : static_cast<unsigned>(value);
    word = words.erase(word, word + 2);
  }
  return random;
}

/// Runs cells in order, those with kernels for GPUs in processes of their own, until `seconds` have gone by (0: all).
/// @return verdicts; "left out" where there was no time
std::vector<std::string> RunCells(const std::vector<Cell>& cells, double seconds)
{
  std::vector<std::string> verdicts(cells.size(), "left out");
  const double start = WallSeconds();
  for (const bool gpu : { false, true })
  {
    std::vector<std::size_t> mine;
    for (std::size_t i = 0; i < cells.size(); ++i)
    {
      if (cells[i].solver->Is(AsGpu) == gpu)
      {
        mine.push_back(i);
      }
    }
    if (gpu)
    {
      setenv("TYNDALL_AS_GPU", "1", 1); // before a child asks for its first device
    }
    const double end = seconds > 0.0 ? start + seconds * (gpu ? 1.0 : 0.75) : HUGE_VAL;
    const std::vector<std::string> found = RunAllApart(
      mine.size(), TimeLimit,
      [&](std::size_t i) { return WallSeconds() < end ? RunCell(cells[mine[i]]) : std::string("left out"); },
      [&](std::size_t i, const std::string& death) {
        LineOf(cells[mine[i]]).Add("verdict", "WRONG").Add("failed", death).Print();
      });
    for (std::size_t i = 0; i < mine.size(); ++i)
    {
      verdicts[mine[i]] = found[i];
    }
  }
  return verdicts;
}
}

int main(int argc, char* argv[])
{
  bench::Arguments arguments = bench::ReadArguments(argc, argv);
  const Random random = TakeRandom(arguments.words);
  // Not asked here: a process that has used OpenCL cannot be forked.
  if (RunApart([] { return test::ThereIsADevice() ? 0 : 1; }, TimeLimit) != 0)
  {
    std::fprintf(stderr, "There is no OpenCL device.\n");
    return std::getenv("TYNDALL_REQUIRE_DEVICE") ? EXIT_FAILURE : 125;
  }
  const std::vector<StressCase> cases = StressCases();
  std::vector<Cell> cells = CellsOf(cases, arguments.quick, arguments.words);
  if (random.seconds > 0.0)
  {
    std::printf("Random cells for %g s: --random %g --seed %u\n", random.seconds, random.seconds, random.seed);
    std::shuffle(cells.begin(), cells.end(), std::mt19937(random.seed));
  }
  const std::vector<std::string> verdicts = RunCells(cells, random.seconds);
  PrintTable(cells, verdicts);
  const auto tried =
    std::count_if(verdicts.begin(), verdicts.end(), [](const std::string& verdict) { return verdict != "left out"; });
  const auto wrong = std::count(verdicts.begin(), verdicts.end(), "WRONG");
  const auto refused = std::count(verdicts.begin(), verdicts.end(), "refused");
  std::printf("\n%td of %zu cells, %td refused, %td WRONG\n", tried, cells.size(), refused, wrong);
  return wrong == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
