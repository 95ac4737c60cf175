#pragma once

#include <hoist/data/cuboid.h>
#include <hoist/data/frame_images.h>
#include <hoist/data/result.h>
#include <hoist/data/sensor_model.h>
#include <hoist/segmentation/box_sizes.h>
#include <hoist/segmentation/export.h>
#include <hoist/segmentation/planar_faces.h>

#include <opencv2/core.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace hoist {

/** \brief What a user may ask of the full mode, beside the sizes. Lengths in metres. */
struct FullModeParameters : BoxSizes {
  SensorModel sensor; ///< every distance threshold follows its sigmaZ

  double min_score = 0.5; ///< cuboids below are not reported, in [0, 1]
  int max_cuboids = 0;    ///< keep the best n; 0 = all

  /// Also report boxes of which one face alone is seen, CuboidModel::face. Where no
  /// surface carries them and no catalogue knows them, their third side is
  /// DimensionSource::unknown. Every flat rectangle is one, such as a table's top.
  bool single_faces = false;

  /// What the boxes stand on, if it is known: a x + b y + c z + d = 0 in the camera
  /// frame [m], (a, b, c) of any length but 0. Hidden ends reach down to it.
  std::optional<Eigen::Vector4d> support_plane;

  HOIST_SEGMENTATION_EXPORT bool valid() const;
};

/** \brief A box that was thought of, and what became of it. */
struct CuboidVerdict {
  Cuboid cuboid;        ///< as refined, if it came so far
  std::string rejected; ///< why it is not reported; "" if it is
  double flat = 0;      ///< share of its uncovered area that lies on its faces
  double outline = 0;   ///< share of its outline where the surface ends
  double trust = 0;     ///< how well its ends are known, in [0, 1]

  /// Reported ones first, then those that came nearest to it.
  double
  rank() const
  {
    return (rejected.empty() ? 2 : 0) + cuboid.score + flat * outline * trust;
  }
};

/** \brief All cuboids of a frame from its flat faces and where they end.
 *
 * Holds the buffers that are reused from frame to frame; not thread safe, use one per
 * thread.
 */
class HOIST_SEGMENTATION_EXPORT FullMode {
public:
  FullMode();
  ~FullMode();
  FullMode(FullMode&&) noexcept;
  FullMode& operator=(FullMode&&) noexcept;

  /** \param images the frame; intrinsics must be valid
   *  \param mask pixels to use (non-zero), height x width, or empty for all
   *  \param cuboids cleared, then filled, best score first
   *  \param diagnostics counts and reject reasons are added
   *  \param parameters valid()
   *  \return false if the frame has no valid intrinsics; outputs are then empty */
  bool segment(const FrameImages& images,
               const cv::Mat1b& mask,
               const FullModeParameters& parameters,
               std::vector<Cuboid>& cuboids,
               Diagnostics& diagnostics);

  /** \brief All boxes that the last call thought of, rank() descending.
   *  \param images the frame of that call; those that could come to nothing were not
   *         looked at then, and are now */
  std::vector<CuboidVerdict> verdicts(const FrameImages& images) const;

  /** \brief Those of them that cover a pixel, whatever may stand in front. */
  std::vector<CuboidVerdict> verdictsAt(const FrameImages& images, int u, int v) const;

  /** \brief The flat face at a pixel in the last call, nullptr where there is none;
   * valid until the next. */
  const PlanarFace* faceAt(int u, int v) const;

private:
  void findFaces(const FrameImages& images,
                 const cv::Mat1b& mask,
                 const FullModeParameters& parameters,
                 Diagnostics& diagnostics);
  void makeHypotheses(const FrameImages& images,
                      const FullModeParameters& parameters,
                      Diagnostics& diagnostics);

  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

} // namespace hoist
