// Files are changed as a whole or not at all, and back.
#include "data/ifc/ifc_things.h"
#include "data/temp_folder.h"

#include <hoist/data/ifc/ifc_journal.h>

#include <gtest/gtest.h>

#include <pcl/exceptions.h>

#include <atomic>
#include <filesystem>
#include <string>
#include <thread>

namespace {

using hoist::IfcEdit;
using hoist::IfcModel;
using hoist::test::boxAt;
using hoist::test::exportedModel;
using hoist::test::readFile;
using hoist::test::TempFolder;
using hoist::test::thing;

bool
put(const std::string& file, const std::string& key, double x)
{
  const IfcModel model = IfcModel::load(file);
  IfcEdit edit(model);
  edit.put(thing(key, boxAt(x, 0, 1)));
  return commitIfc(file, edit.part21());
}

std::size_t
filesIn(const std::filesystem::path& folder)
{
  std::size_t n = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    n += entry.exists() ? 1 : 0;
  return n;
}

TEST(IfcJournal, EveryUpdateCanBeUndone)
{
  const TempFolder folder;
  const std::string file = folder.write("m.ifc", exportedModel());
  std::vector<std::string> states = {readFile(file)};
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(put(file, std::to_string(i % 3), i));
    states.push_back(readFile(file));
    EXPECT_FALSE(put(file, std::to_string(i % 3), i)); // no change, no entry
  }
  EXPECT_EQ(filesIn(folder.path()), 2u); // the model and its journal
  for (int i = 5; i-- > 0;) {
    EXPECT_TRUE(hoist::undoIfc(file));
    EXPECT_EQ(readFile(file), states[i]);
  }
  EXPECT_FALSE(hoist::undoIfc(file));
  EXPECT_EQ(readFile(file), exportedModel());
}

TEST(IfcJournal, ForgetsWhatIsOld)
{
  const TempFolder folder;
  const std::string file = folder.write("m.ifc", exportedModel());
  const int updates = static_cast<int>(hoist::ifc_journal_length) + 3;
  for (int i = 0; i < updates; ++i)
    EXPECT_TRUE(put(file, "a", i));
  int undone = 0;
  while (hoist::undoIfc(file))
    ++undone;
  EXPECT_EQ(undone, static_cast<int>(hoist::ifc_journal_length));
}

TEST(IfcJournal, WhatOthersChangedIsLeftAlone)
{
  const TempFolder folder;
  const std::string file = folder.write("m.ifc", exportedModel());
  ASSERT_TRUE(put(file, "a", 0));
  const std::string theirs = readFile(file) + "\n";
  folder.write("m.ifc", theirs);
  EXPECT_THROW((void)hoist::undoIfc(file), pcl::IOException);
  EXPECT_EQ(readFile(file), theirs);

  // between reading and writing, too
  const IfcModel model = IfcModel::load(file);
  IfcEdit edit(model);
  edit.put(thing("b", boxAt(1, 0, 1)));
  folder.write("m.ifc", exportedModel());
  EXPECT_THROW((void)commitIfc(file, edit.part21()), pcl::IOException);
  EXPECT_EQ(readFile(file), exportedModel());
}

TEST(IfcJournal, ACrashBetweenTheTwoFiles)
{
  const TempFolder folder;
  const std::string file = folder.write("m.ifc", exportedModel());
  ASSERT_TRUE(put(file, "a", 0));
  const std::string one = readFile(file);
  ASSERT_TRUE(put(file, "a", 1));
  // the journal has the second update, the model does not
  folder.write("m.ifc", one);
  EXPECT_TRUE(hoist::undoIfc(file));
  EXPECT_EQ(readFile(file), exportedModel());
}

TEST(IfcJournal, BrokenJournalsAreToldAndHarmNothing)
{
  const TempFolder folder;
  const std::string file = folder.write("m.ifc", exportedModel());
  ASSERT_TRUE(put(file, "a", 0));
  const std::string model = readFile(file);
  const std::string journal = readFile(file + ".journal");
  for (std::size_t n = 0; n + 2 < journal.size(); n += 7) {
    folder.write("m.ifc.journal", journal.substr(0, n));
    EXPECT_THROW((void)hoist::undoIfc(file), hoist::LoadError) << n;
    EXPECT_EQ(readFile(file), model);
  }
  std::string wrong = journal;
  wrong.replace(wrong.find("\"at\": ") + 6, 1, "99999999");
  folder.write("m.ifc.journal", wrong);
  EXPECT_THROW((void)hoist::undoIfc(file), hoist::LoadError);
  EXPECT_THROW((void)put(file, "b", 1), hoist::LoadError);
  EXPECT_EQ(readFile(file), model);
}

TEST(IfcJournal, LinksAndPermissionsStay)
{
  const TempFolder folder;
  const std::string file = folder.write("m.ifc", exportedModel());
  namespace fs = std::filesystem;
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink(file, folder.path() / "link.ifc");
  EXPECT_TRUE(put(folder.name("link.ifc"), "a", 0));
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link.ifc"));
  EXPECT_EQ(fs::status(file).permissions(),
            fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_TRUE(hoist::undoIfc(folder.name("link.ifc")));
  EXPECT_EQ(readFile(file), exportedModel());
}

TEST(IfcJournal, AReaderAlwaysSeesAWholeModel)
{
  const TempFolder folder;
  const std::string file = folder.write("m.ifc", exportedModel());
  std::atomic<bool> done{false};
  std::thread writer([&] {
    for (int i = 0; i < 40; ++i)
      put(file, std::to_string(i % 4), i);
    done = true;
  });
  int read = 0;
  do {
    EXPECT_NO_THROW((void)IfcModel::load(file));
    ++read;
  } while (!done);
  writer.join();
  EXPECT_GT(read, 0);
}

} // namespace
