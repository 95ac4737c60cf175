#include "batch/merge.h"

#include "batch/report.h"
#include "batch/summary_csv.h"
#include "batch/summary_sqlite.h"

#include <hoist/data/result_io.h>

namespace hoist {

MergeCounts
mergeRecords(Store& store,
             const RecordCheck& check,
             const std::vector<InputFile>& files,
             const std::string& settings,
             std::size_t most_rows,
             const StopSignal& stop)
{
  MergeCounts counts;
  const auto files_csv = store.newName(), cuboids_csv = store.newName(),
             database = store.newName(), page = store.newName();
  SummaryCsv csv(files_csv, cuboids_csv);
  SummarySqlite sqlite(database, check.version, settings);
  Report report(check.version, settings, most_rows);
  for (const InputFile& file : files) {
    if (stop.received() != 0)
      return counts;
    std::string text;
    const std::optional<RecordHead> head = check.finished(file, text);
    if (!head) {
      if (counts.missing++ == 0)
        counts.first_missing = file.path;
      continue;
    }
    FrameResult result;
    if (head->verdict.cause == Cause::none)
      result = fromJson(text, recordFile(file));
    const std::string thumbnail = thumbnailOf(text);
    const std::string record = recordFile(file);
    const SummaryEntry entry{*head, result, thumbnail, record};
    csv.add(entry);
    sqlite.add(entry);
    report.add(entry);
  }
  counts.files = report.files();
  counts.quarantined = report.quarantined();
  counts.cuboids = report.cuboids();
  if (counts.missing > 0)
    return counts;
  csv.close();
  sqlite.close();
  TextFile html(page);
  html.write(report.html());
  html.close();
  store.publish(files_csv, "files.csv");
  store.publish(cuboids_csv, "cuboids.csv");
  store.publish(database, "summary.sqlite");
  store.publish(page, "report.html");
  return counts;
}

} // namespace hoist
