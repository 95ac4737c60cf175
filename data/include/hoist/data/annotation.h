#pragma once

#include <hoist/data/export.h>
#include <hoist/data/intrinsics.h>
#include <hoist/data/load_error.h>

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace hoist {

/** \brief What became of a thing since the visit before. */
enum class ObjectStatus { unchanged, added, moved, removed };

/** \brief Words as in files: "unchanged", "new", "moved", "removed". */
HOIST_DATA_EXPORT const char* toString(ObjectStatus status);

/** \brief Turns that leave a thing as it is, so that they count as no rotation error.
 */
enum class ObjectSymmetry {
  box,   ///< the ways to name a box's axes: 24 if its sides are not told apart
  axis0, ///< any turn about the box's axis 0, and the ways of a box
  axis1, ///< likewise about axis 1, e.g. a bucket that stands along it
  axis2  ///< likewise about axis 2
};

/** \brief Words as in files: "box", "axis 0", "axis 1", "axis 2". */
HOIST_DATA_EXPORT const char* toString(ObjectSymmetry symmetry);

/** \brief The truth about one thing in a frame. What is not set is not known, and is
 *  not in the file either.
 *
 * Frame: the camera's (x right, y down, z forward), metres. Invariants of what is read
 * from a file: center, size and rotation are finite, size > 0, rotation is orthonormal
 * within 1e-3 in every entry (a left-handed one names the same box and is kept).
 */
struct AnnotatedObject {
  /// Its number: the value of its pixels in the image of instances, 1 ... 65535, unique
  /// in a frame, and the same in all frames of a sequence. 0: none.
  int label = 0;
  std::string
      object_class;      ///< "safety cone", "hard hat", "slab", ...; "" if none is set
  bool is_cuboid = true; ///< its shape is a cuboid, not only the box around it

  Eigen::Vector3d center = Eigen::Vector3d::Zero();       ///< of the box [m]
  Eigen::Vector3d size = Eigen::Vector3d::Zero();         ///< full side lengths [m]
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity(); ///< columns: the box's axes
  ObjectSymmetry symmetry = ObjectSymmetry::box;
  std::optional<Eigen::Isometry3d> pose; ///< the mesh's own frame to the camera's

  bool difficult = false; ///< finding it is no hit, missing it is no miss
  std::vector<std::string> difficult_reasons;

  /// Smallest upright box around its visible pixels: left, top, width, height [px].
  std::optional<std::array<double, 4>> box_2d;
  std::optional<double> visible_fraction; ///< of the pixels that it alone would cover
  std::optional<std::int64_t> visible_pixels;
  std::optional<int> faces_visible;                  ///< 0 ... 6
  std::optional<std::array<bool, 6>> observed_faces; ///< +axis 0, -axis 0, +axis 1, ...

  std::string material;                       ///< "" if not known
  std::optional<std::array<int, 3>> base_rgb; ///< dominant colour, the albedo in sRGB
  std::optional<bool> fullness; ///< of a container: something protrudes from it
  std::optional<double> weight; ///< [kg]

  std::optional<ObjectStatus> status; ///< since the visit before
  /// Its box (axes and centre) at the visit before, in this frame's camera frame; of
  /// what was moved.
  std::optional<Eigen::Isometry3d> moved_from;
  std::string global_id; ///< of the element in the building model (IFC GlobalId)

  /// What else the file says of it, as the text of a JSON object; "" for nothing. It is
  /// written back as it was.
  std::string extra;
};

/** \brief Something in view of which no box is given. */
struct OtherObject {
  int label = 0;                         ///< as AnnotatedObject::label
  std::string kind;                      ///< "cylinder", "person", ...
  std::optional<Eigen::Vector3d> center; ///< [m]
  std::string extra;                     ///< as AnnotatedObject::extra
};

/** \brief Where the data of a frame is; names relative to the folder of the annotation.
 */
struct FrameFiles {
  std::string cloud;     ///< PCD, PTS or PLY, organized
  std::string color;     ///< 8-bit RGB image, e.g. JPEG
  std::string depth;     ///< 16-bit PNG, z in units of depth_scale, 0 for none
  std::string instances; ///< 16-bit PNG, the label of what each pixel shows, 0 for none
  std::string extra;     ///< as AnnotatedObject::extra

  bool
  empty() const
  {
    return cloud.empty() && color.empty() && depth.empty() && instances.empty() &&
           extra.empty();
  }
};

/** \brief All that is true of one frame; the schema is in docs/annotations.md. */
struct FrameAnnotation {
  std::string scene;  ///< its name; when read and not given, the file's stem
  int width = 0;      ///< of the frame [px]; 0 if not known
  int height = 0;     ///< [px]
  std::string sensor; ///< "kinect", "depth", "stereo", ...
  std::optional<double> baseline;    ///< of a stereo pair or a projector [m]
  std::optional<std::uint64_t> seed; ///< of the simulator

  Intrinsics intrinsics; ///< not valid() if not known
  /// Lens distortion in OpenCV's order k1 k2 p1 p2 k3 (4, 5, 8, 12 or 14 numbers) of
  /// the colour image; empty: none, or removed.
  std::vector<double> distortion;
  std::optional<Eigen::Isometry3d> pose; ///< sensor to world
  /// From the depth sensor's frame to the colour camera's, where colour was not
  /// registered to depth exactly.
  std::optional<Eigen::Isometry3d> registration;
  /// What things stand on, a x + b y + c z + d = 0 in the camera frame; (a, b, c) is a
  /// unit vector towards the camera's side, so d >= 0.
  std::optional<Eigen::Vector4d> support_plane;

  FrameFiles files;
  std::optional<double> depth_scale; ///< of files.depth [m per unit]

  std::string sequence;       ///< the name of a robot's way through a site; "" for none
  std::optional<int> visit;   ///< of the site, from 1
  std::optional<int> index;   ///< number in the visit, from 0
  std::optional<double> time; ///< since the start of the visit [s]

  std::vector<AnnotatedObject> objects; ///< cuboids and others
  std::vector<AnnotatedObject> removed; ///< where things were at the visit before
  std::vector<OtherObject> other_objects;
  std::string extra; ///< as AnnotatedObject::extra
};

/** \brief The annotation as JSON text. Doubles come back bit for bit.
 *  \param indent spaces per level; -1 for one line
 *  \throws pcl::BadArgumentException if a number is not finite or an extra is not the
 *  text of a JSON object */
HOIST_DATA_EXPORT std::string toJson(const FrameAnnotation& annotation, int indent = 1);

/** \brief The annotation in a JSON text.
 *
 * Also reads files with cuboids only, as the truth of mOSD: everything is optional but
 * one of the lists `cuboids` and `objects`, and center, size and rotation in them.
 * \param name of the file, for messages
 * \throws LoadError with the place as position(), e.g. "cuboids[3].size", and what was
 * expected there as reason() */
HOIST_DATA_EXPORT FrameAnnotation annotationFromJson(const std::string& text,
                                                     const std::string& name = "JSON");

/** \brief Writes toJson() so that readers see the old file or the new one.
 *  \throws pcl::IOException, pcl::BadArgumentException */
HOIST_DATA_EXPORT void saveAnnotation(const std::filesystem::path& file,
                                      const FrameAnnotation& annotation);

/** \brief Reads what saveAnnotation() wrote, up to 256 MB.
 *  \throws LoadError */
HOIST_DATA_EXPORT FrameAnnotation loadAnnotation(const std::filesystem::path& file);

} // namespace hoist
