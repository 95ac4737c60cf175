#pragma once

#include <hoist/data/export.h>
#include <hoist/data/load_error.h>

#include <Eigen/Core>

#include <pcl/PCLPointField.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace hoist {

/** \brief How a PTS file is to be read. */
struct PTSOptions {
  /// Names of the columns, separated by spaces; "" detects them. Known: x y z, r g b a
  /// (0..255), i or intensity, u or col, v or row, nx ny nz, _ (skip); any other name
  /// becomes a float field of that name.
  std::string fields;
  /// Records that know their pixels become an organized cloud.
  bool organize = true;
  /// Size of that cloud [px]; 0: the smallest usual camera size that holds all records,
  /// or just their extent where none fits closely.
  int width = 0;
  int height = 0;
  /// Subtracted from x, y, z before they are rounded to float [m]: surveyed files hold
  /// coordinates that a float cannot.
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
};

/** \brief What was found in a PTS file. */
struct PTSReport {
  std::string dialect; ///< "Bumblebee", "XYZ", "XYZI", "XYZRGB", "XYZIRGB", "header",
                       ///< "x y z u v R G B" or "given"
  std::vector<std::string> fields;     ///< one name per column
  std::optional<std::size_t> declared; ///< the count line, if there is one
  std::size_t records = 0;             ///< lines with a point
  std::size_t without_depth =
      0; ///< of them, dropped: z <= 0 with a pixel, or not finite
  std::size_t repeated_pixels = 0;   ///< records on a pixel that had one already
  bool unit_colors = false;          ///< colours were given as 0..1
  std::vector<std::string> warnings; ///< in words, for people
};

/** \brief Reads the records of a PTS file block by block, in bounded memory.
 *
 * The dialects and how they are told apart: docs/pts.md. A block is a run of records as
 * pcl::PCLPointCloud2 stores them. Most users want loadPTSFile() or PTSReader instead.
 */
class HOIST_DATA_EXPORT PTSStream {
public:
  /** \brief Opens the file, finds its dialect and counts its records.
   *  \throws LoadError */
  explicit PTSStream(const std::string& file,
                     const PTSOptions& options = {},
                     std::size_t byte_offset = 0);
  ~PTSStream();
  PTSStream(const PTSStream&) = delete;
  PTSStream& operator=(const PTSStream&) = delete;

  /** \brief The fields of a record, 4 bytes each, without gaps. */
  const std::vector<pcl::PCLPointField>& fields() const;

  /** \brief Bytes of a record. */
  std::size_t pointStep() const;

  /** \brief Lines that can be records: an upper bound of what next() gives. */
  std::size_t maxRecords() const;

  /** \brief Whether the records belong on a grid of width() x height(). */
  bool organized() const;

  int width() const;

  int height() const;

  /** \brief The next records.
   *
   * Records without depth are left out of a file that is not organized; in an organized
   * one they come with NaN coordinates, because they carry colour.
   * \param block pointStep() bytes each, one after the other
   * \return how many; 0 at the end of the file
   * \throws LoadError naming the line
   */
  std::size_t next(std::vector<std::uint8_t>& block);

  /** \brief One row of a grid on which nothing was measured. */
  void blankRow(int row, std::vector<std::uint8_t>& block) const;

  /** \brief Column, row and depth of a record of an organized file.
   *  \param z NaN where nothing was measured */
  void pixelOf(const std::uint8_t* record, int& u, int& v, float& z) const;

  /** \brief Complete after next() has returned 0. */
  const PTSReport& report() const;

  PTSReport& report();

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace hoist
