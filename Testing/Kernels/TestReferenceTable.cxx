#include "Reference/CubeReference.h"
#include "Reference/KobayashiReference.h"
#include "Reference/PfeutiTimes.h"
#include "Reference/ReferenceTable.h"
#include "Reference/SlabReference.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>

#include <unistd.h>

using testing::AllOf;
using testing::HasSubstr;

namespace
{
/// A table of the test's own, gone when it is done.
class TableFile
{
public:
  explicit TableFile(const std::string& text)
    : Path(testing::TempDir() + "table-" + std::to_string(getpid()) + ".csv")
  {
    std::ofstream(this->Path) << text;
  }
  ~TableFile() { std::remove(this->Path.c_str()); }

  const std::string Path;
};

std::string ComplaintOf(const std::function<void()>& work)
{
  try
  {
    work();
  }
  catch (const std::runtime_error& complaint)
  {
    return complaint.what();
  }
  return "no complaint";
}
}

TEST(ReferenceTable, HasNumbersToTheLastDigit)
{
  const TableFile file("# what it is\ntau,name,q\n1,thin,1.23456789012345678e-01\n1e3,,-0.5\n");
  const std::vector<ReferenceRow> rows = ReadTable(file.Path);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0]["tau"], 1.0);
  EXPECT_EQ(rows[0].Text("name"), "thin");
  EXPECT_EQ(rows[0]["q"], 1.23456789012345678e-01);
  EXPECT_EQ(rows[1]["tau"], 1000.0);
  EXPECT_EQ(rows[1].Text("name"), "");
  EXPECT_EQ(rows[1]["q"], -0.5);
}

TEST(ReferenceTable, NamesWhatIsMissing)
{
  EXPECT_THAT(ComplaintOf([] { ReadReference("nothing"); }),
    AllOf(HasSubstr("Data/Reference/nothing.csv"), HasSubstr("cannot be read")));
  EXPECT_THAT(ComplaintOf([] { SlabOf(0.12345, 0.9); }),
    AllOf(HasSubstr("Data/Reference/slab.csv has 0 rows with tau 0.12345"), HasSubstr(" omega 0.9")));
  EXPECT_THAT(ComplaintOf([] { ReferenceRowWhere("slab", { { "tau", 1.0 } }); }), HasSubstr("has 5 rows with tau 1"));
  EXPECT_THAT(ComplaintOf([] {
    ReferenceRowWhere("slab", { { "thickness", 1.0 } });
  }),
    AllOf(HasSubstr("slab.csv, line 4: there is no column thickness")));
  EXPECT_THAT(ComplaintOf([] { PfeutiPassesOf("dragon", "adaptive"); }), HasSubstr("dragon"));
  EXPECT_THAT(ComplaintOf([] { PfeutiMarchingTimes("Sobol"); }), HasSubstr("Sobol"));
}

TEST(ReferenceTable, RefusesDamagedFiles)
{
  const auto complaint = [](const char* text) {
    const TableFile file(text);
    return ComplaintOf([&] { ReadTable(file.Path).front()["b"]; });
  };
  EXPECT_THAT(complaint(""), HasSubstr("has no rows"));
  EXPECT_THAT(complaint("# only\na,b\n"), HasSubstr("has no rows"));
  EXPECT_THAT(complaint("a,b\n1\n"), HasSubstr("line 2 has 1 cells, the head 2"));
  EXPECT_THAT(complaint("a,b\n1,2,3\n"), HasSubstr("line 2 has 3 cells, the head 2"));
  EXPECT_THAT(complaint("a,b\n1,\n"), HasSubstr("line 2, column b: '' is not a number"));
  EXPECT_THAT(complaint("a,b\n1,2x\n"), HasSubstr("line 2, column b: '2x' is not a number"));
  EXPECT_THAT(complaint("a,c\n1,2\n"), HasSubstr("line 2: there is no column b"));
  EXPECT_EQ(complaint("a,b\r\n1,2\r\n"), "no complaint");
}

// A file with columns in another order, or rows lost, would not agree with this.
TEST(ReferenceTable, TablesHoldWhatPhysicsSaysOfThem)
{
  for (double tau : { 0.1, 1.0, 10.0, 1000.0 })
  {
    const SlabReference white = SlabOf(tau, 1.0);
    EXPECT_NEAR(white.diffuseR + white.diffuseT, 1.0, 1e-8) << tau;
    EXPECT_NEAR(white.beamR + white.beamT, 1.0, 1e-8) << tau;
    EXPECT_LT(white.obliqueT, white.beamT) << tau;
  }
  EXPECT_NEAR(SlabOf(100.0, 1.0).diffuseT / ThickSlabTransmittance(100.0), 1.0, 1e-7);
  EXPECT_NEAR(SlabOf(100.0, 1.0).beamT / ThickSlabBeamTransmittance(100.0, 1.0), 1.0, 1e-7);
  EXPECT_NEAR(SlabOf(100.0, 1.0).obliqueT / ThickSlabBeamTransmittance(100.0, 0.5), 1.0, 1e-7);
  for (double tau : { 0.1, 1.0, 5.0, 50.0 })
  {
    const CubePowers cube = CubePowersOf(tau, 0.9);
    EXPECT_NEAR(cube.part[0] + cube.part[1] + cube.part[2] + cube.part[3], 1.0, 1e-5) << tau;
  }
  // What the voxels absorb is what the cube does, both from Monte Carlo runs of their own.
  double absorbed = 0.0;
  for (const CubeVoxel& voxel : CubeInDiffuseLight())
  {
    absorbed += 0.1 * voxel.fluence / 1000.0;
  }
  EXPECT_NEAR(absorbed, CubePowersOf(1.0, 0.9).part[3], 1e-4);
  double shone = 0.0;
  for (const CubeVoxel& voxel : ShiningCube())
  {
    shone += 0.5 * voxel.fluence / 1000.0;
  }
  EXPECT_GT(shone, 0.0);
  EXPECT_LT(shone, 1.0); // of the power emitted
  for (const KobayashiReference& point : KobayashiProblem1())
  {
    EXPECT_GT(point.half, point.absorber) << point.point[0] << ' ' << point.point[1] << ' ' << point.point[2];
    EXPECT_NEAR(point.half / point.published, 1.0, 0.15);
  }
  EXPECT_EQ(KobayashiProblem1().size(), 28u);
  EXPECT_EQ(PfeutiPassesOf("ball", "reference").photons, 122000u);
  EXPECT_EQ(PfeutiPassesOf("ball", "reference").pilot, 0.0);
  EXPECT_EQ(PfeutiMarchingTimes("grid"), "158, 191");
}
