#pragma once

#include <hoist/data/export.h>
#include <hoist/data/load_error.h>

#include <Eigen/Core>

#include <opencv2/core.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace hoist {

/** \brief A thing that somebody outlined in an image, in the way of COCO. */
struct CocoAnnotation {
  std::int64_t id = 0;
  std::string category; ///< name of its category

  /// Outlines as x0 y0 x1 y1 ... in pixels from the image's top left corner, so that
  /// the centre of the first pixel is (0.5, 0.5); or run lengths, down the columns, of
  /// 0 and 1 in turn. Both empty: only the box is known.
  std::vector<std::vector<double>> polygons;
  std::vector<std::uint32_t> runs;
  std::optional<std::array<double, 4>> bbox; ///< left, top, width, height [px]
  bool crowd = false;                        ///< many things in one outline

  // Fields beyond COCO's, of the annotation or of its "attributes".
  std::string material;
  std::optional<std::array<int, 3>> rgb; ///< "color", "rgb" or "base_rgb"
  std::optional<bool> fullness;
  std::optional<double> weight; ///< [kg]
};

struct CocoImage {
  std::int64_t id = 0;
  std::string file_name;
  int width = 0;  ///< [px]
  int height = 0; ///< [px]
  std::vector<CocoAnnotation> annotations;
};

/** \brief Reads a COCO file of instances: `images`, `annotations`, `categories`.
 *  \return the images in the order of the file, each with its annotations
 *  \throws LoadError with file, place and what was expected */
HOIST_DATA_EXPORT std::vector<CocoImage> loadCoco(const std::filesystem::path& file);

/** \brief The same of a text; \a name of the file, for messages.
 *  \throws LoadError */
HOIST_DATA_EXPORT std::vector<CocoImage> cocoFromJson(const std::string& text,
                                                      const std::string& name = "JSON");

/** \brief 255 where the thing is: pixels whose centre lies in an outline (even-odd
 *  within one, joined over several), or of the runs, or, without either, of the box. */
HOIST_DATA_EXPORT cv::Mat1b
cocoMask(const CocoAnnotation& annotation, int width, int height);

} // namespace hoist
