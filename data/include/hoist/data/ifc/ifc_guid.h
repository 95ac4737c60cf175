#pragma once

#include <hoist/data/export.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace hoist {

/** \brief 128 bits that name a thing for ever (RFC 4122). */
using Uuid = std::array<std::uint8_t, 16>;

/** \brief A UUID as IFC writes it (IfcGloballyUniqueId): 22 characters of
 *  0-9 A-Z a-z _ $, of which the first holds two bits and every other one six. */
HOIST_DATA_EXPORT std::string toIfcGuid(const Uuid& uuid);

/** \brief The UUID of an IFC GlobalId; nothing if it is none. */
HOIST_DATA_EXPORT std::optional<Uuid> fromIfcGuid(std::string_view guid);

/** \brief The UUID of version 5 of a name in a namespace (RFC 4122, 4.3): the same name
 *  always gets the same one. */
HOIST_DATA_EXPORT Uuid nameUuid(const Uuid& space, std::string_view name);

/** \brief The GlobalId of what is called \a key in a project: the UUID of version 5 in
 *  the namespace of the project's GlobalId.
 *  \param project if it is no GlobalId, its text takes part in the name instead */
HOIST_DATA_EXPORT std::string ifcGuidOf(std::string_view project, std::string_view key);

/** \brief SHA-1 of some bytes (FIPS 180-4). Names things and finds mistakes; no defence
 *  against an enemy. */
HOIST_DATA_EXPORT std::array<std::uint8_t, 20> sha1(std::string_view bytes);

/** \brief The same as 40 hexadecimal digits. */
HOIST_DATA_EXPORT std::string sha1Hex(std::string_view bytes);

} // namespace hoist
