#pragma once

#include <hoist/data/export.h>
#include <hoist/data/ifc/part21_edit.h>
#include <hoist/data/load_error.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace hoist {

/** \brief Updates that can be undone; older ones are forgotten. */
constexpr std::size_t ifc_journal_length = 64;

/** \brief The journal of a model: its name with ".journal" behind it. */
HOIST_DATA_EXPORT std::filesystem::path
ifcJournalOf(const std::filesystem::path& model);

/** \brief Writes an edit into the file it was made of, and how to undo it into the
 *  journal beside it.
 *
 * Readers see the old file or the new one, also after a power cut, and whatever happens
 * the journal can undo what was written. An edit that changes nothing touches neither.
 * \return whether the file changed
 * \throws pcl::IOException if it cannot be written, or is not what the edit was made of
 * any more: then it is as it was
 * \throws LoadError if the journal is broken */
HOIST_DATA_EXPORT bool commitIfc(const std::filesystem::path& model,
                                 const Part21Edit& edit);

/** \brief Takes the last update back: the file has the bytes it had before.
 *  \return false, and nothing done, if there is no update to undo
 *  \throws pcl::IOException if the file was changed by somebody else since then, or
 *  cannot be written
 *  \throws LoadError if the journal is broken */
HOIST_DATA_EXPORT bool undoIfc(const std::filesystem::path& model);

} // namespace hoist
