#include "batch/summary_csv.h"

#include "batch/store.h"

#include <hoist/data/result_io.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace hoist {
namespace {

[[noreturn]] void
fail(const std::filesystem::path& path)
{
  throw StoreError(path.string() +
                   ": cannot be written: " + std::generic_category().message(errno));
}

} // namespace

TextFile::TextFile(const std::filesystem::path& path)
: path_(path), file_(std::fopen(path.c_str(), "wbe"))
{
  if (file_ == nullptr)
    fail(path_);
}

TextFile::~TextFile()
{
  if (file_ != nullptr)
    std::fclose(file_);
}

void
TextFile::write(const std::string& text)
{
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size())
    fail(path_);
}

void
TextFile::close()
{
  const int failed = std::fclose(file_);
  file_ = nullptr;
  if (failed != 0)
    fail(path_);
}

SummaryCsv::SummaryCsv(const std::filesystem::path& files,
                       const std::filesystem::path& cuboids)
: files_(files), cuboids_(cuboids)
{
  files_.write("path,status,cause,reason,cuboids,best_score,width,height,bytes,"
               "record\r\n");
  cuboids_.write(toCsv(FrameResult()));
}

void
SummaryCsv::add(const SummaryEntry& entry)
{
  const RecordHead& head = entry.head;
  const FrameResult& result = entry.result;
  const bool done = head.verdict.cause == Cause::none;
  std::string line = csvField(head.path) + ',' + head.status() + ',' +
                     toString(head.verdict.cause) + ',' + csvField(head.verdict.reason);
  double best = 0;
  for (const RecognizedCuboid& item : result.cuboids)
    best = std::max(best, item.cuboid.score);
  char score[32] = "";
  if (!result.cuboids.empty())
    (void)std::snprintf(score, sizeof score, "%.3f", best);
  line += done ? ',' + std::to_string(result.cuboids.size()) + ',' + score + ',' +
                     std::to_string(result.width) + ',' + std::to_string(result.height)
               : ",,,,";
  line += ',' + (head.stamp.exists ? std::to_string(head.stamp.size) : "");
  files_.write(line + ',' + csvField(entry.record) + "\r\n");

  FrameResult named = result;
  named.scene = head.path;
  cuboids_.write(toCsv(named, false));
}

void
SummaryCsv::close()
{
  files_.close();
  cuboids_.close();
}

} // namespace hoist
