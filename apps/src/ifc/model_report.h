#pragma once

#include <hoist/data/ifc/ifc_model.h>

#include <string>

namespace hoist {

/** \brief What is in a model, as a table: one line per element. */
std::string modelTable(const IfcModel& model);

/** \brief The same as JSON, with the property sets. */
std::string modelJson(const IfcModel& model);

} // namespace hoist
