#include "batch/summary_sqlite.h"

#include <hoist/data/result_io.h>

namespace hoist {
namespace {

constexpr const char* schema = R"(
CREATE TABLE run(key TEXT PRIMARY KEY, value TEXT) WITHOUT ROWID;
CREATE TABLE files(
  id INTEGER PRIMARY KEY, path TEXT NOT NULL, status TEXT NOT NULL, cause TEXT,
  reason TEXT, bytes INTEGER, mtime_ns INTEGER, width INTEGER, height INTEGER,
  cuboids INTEGER, record TEXT NOT NULL);
CREATE TABLE cuboids(
  file INTEGER NOT NULL REFERENCES files(id), number INTEGER NOT NULL, score REAL,
  model TEXT, center_x REAL, center_y REAL, center_z REAL, length REAL, width REAL,
  height REAL, qw REAL, qx REAL, qy REAL, qz REAL, length_sigma REAL,
  width_sigma REAL, height_sigma REAL, length_source TEXT, width_source TEXT,
  height_source TEXT, color TEXT, red INTEGER, green INTEGER, blue INTEGER,
  material TEXT, weight REAL, world_x REAL, world_y REAL, world_z REAL,
  PRIMARY KEY(file, number)) WITHOUT ROWID;
CREATE TABLE counts(
  file INTEGER NOT NULL REFERENCES files(id), kind TEXT NOT NULL, name TEXT NOT NULL,
  count INTEGER, PRIMARY KEY(file, kind, name)) WITHOUT ROWID;
)";

std::int64_t
whole(std::size_t number)
{
  return static_cast<std::int64_t>(number);
}

} // namespace

SummarySqlite::SummarySqlite(const std::filesystem::path& path,
                             const std::string& version,
                             const std::string& settings)
: file_(path)
{
  file_.execute(schema);
  SqliteInsert run(file_, "run", 2);
  run.add(std::string("version")).add(version).end();
  run.add(std::string("settings")).add(settings).end();
  files_.emplace(file_, "files", 11);
  cuboids_.emplace(file_, "cuboids", 29);
  counts_.emplace(file_, "counts", 4);
}

void
SummarySqlite::add(const SummaryEntry& entry)
{
  const RecordHead& head = entry.head;
  const FrameResult& result = entry.result;
  ++id_;
  files_->add(id_).add(head.path).add(std::string(head.status()));
  if (head.verdict.cause == Cause::none)
    files_->addNull().addNull();
  else
    files_->add(std::string(toString(head.verdict.cause))).add(head.verdict.reason);
  if (head.stamp.exists)
    files_->add(static_cast<std::int64_t>(head.stamp.size)).add(head.stamp.mtime);
  else
    files_->addNull().addNull();
  if (head.verdict.cause == Cause::none)
    files_->add(std::int64_t{result.width})
        .add(std::int64_t{result.height})
        .add(whole(result.cuboids.size()));
  else
    files_->addNull().addNull().addNull();
  files_->add(entry.record).end();

  for (std::size_t i = 0; i < result.cuboids.size(); ++i)
    addCuboid(result, i);
  const auto count = [&](const char* kind, const Tally& tally) {
    for (const auto& [name, n] : tally.entries())
      counts_->add(id_)
          .add(std::string(kind))
          .add(std::string(name))
          .add(whole(n))
          .end();
  };
  count("made", result.diagnostics.counts);
  count("rejected", result.diagnostics.rejected);
}

void
SummarySqlite::addCuboid(const FrameResult& result, std::size_t i)
{
  const Cuboid& cuboid = result.cuboids[i].cuboid;
  const CuboidFeatures& features = result.cuboids[i].features;
  SqliteInsert& row = *cuboids_;
  row.add(id_).add(whole(i + 1)).add(cuboid.score);
  row.add(std::string(toString(cuboid.model)));
  const Eigen::Quaterniond q(cuboid.axes);
  for (int k = 0; k < 3; ++k)
    row.add(cuboid.center[k]);
  for (int k = 0; k < 3; ++k)
    row.add(cuboid.size[k]);
  row.add(q.w()).add(q.x()).add(q.y()).add(q.z());
  for (int k = 0; k < 3; ++k)
    row.add(cuboid.size_sigma[k]);
  for (const DimensionSource source : cuboid.dimension_source)
    row.add(std::string(toString(source)));
  row.add(features.color_name);
  for (const unsigned char value : features.rgb)
    row.add(std::int64_t{value});
  row.add(features.material).add(features.weight);
  const Eigen::Vector3d world = result.pose * cuboid.center;
  for (int k = 0; k < 3; ++k)
    if (result.pose_known)
      row.add(world[k]);
    else
      row.addNull();
  row.end();
}

void
SummarySqlite::close()
{
  files_.reset();
  cuboids_.reset();
  counts_.reset();
  file_.close();
}

} // namespace hoist
