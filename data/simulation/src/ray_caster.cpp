#include <hoist/simulation/ray_caster.h>

#if HOIST_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cmath>
#include <stdexcept>

namespace hoist {
namespace simulation {

namespace {

// Embree 4 takes its hints in other structures than Embree 3.
#if HOIST_EMBREE_MAJOR >= 4
void
intersect(RTCScene scene, RTCRayHit& ray)
{
  rtcIntersect1(scene, &ray);
}

void
intersect(RTCScene scene, const int* valid, RTCRayHit4& rays)
{
  RTCIntersectArguments hints;
  rtcInitIntersectArguments(&hints);
  hints.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcIntersect4(valid, scene, &rays, &hints);
}

void
occluded(RTCScene scene, RTCRay& ray)
{
  rtcOccluded1(scene, &ray);
}

void
occluded(RTCScene scene, const int* valid, RTCRay4& rays)
{
  RTCOccludedArguments hints;
  rtcInitOccludedArguments(&hints);
  hints.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcOccluded4(valid, scene, &rays, &hints);
}
#else
RTCIntersectContext
context(RTCIntersectContextFlags flags)
{
  RTCIntersectContext hints;
  rtcInitIntersectContext(&hints);
  hints.flags = flags;
  return hints;
}

void
intersect(RTCScene scene, RTCRayHit& ray)
{
  RTCIntersectContext hints = context(RTC_INTERSECT_CONTEXT_FLAG_NONE);
  rtcIntersect1(scene, &hints, &ray);
}

void
intersect(RTCScene scene, const int* valid, RTCRayHit4& rays)
{
  RTCIntersectContext hints = context(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
  rtcIntersect4(valid, scene, &hints, &rays);
}

void
occluded(RTCScene scene, RTCRay& ray)
{
  RTCIntersectContext hints = context(RTC_INTERSECT_CONTEXT_FLAG_NONE);
  rtcOccluded1(scene, &hints, &ray);
}

void
occluded(RTCScene scene, const int* valid, RTCRay4& rays)
{
  RTCIntersectContext hints = context(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
  rtcOccluded4(valid, scene, &hints, &rays);
}
#endif

RTCRay
rayFrom(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double far)
{
  RTCRay ray{};
  ray.org_x = static_cast<float>(origin.x());
  ray.org_y = static_cast<float>(origin.y());
  ray.org_z = static_cast<float>(origin.z());
  ray.dir_x = static_cast<float>(direction.x());
  ray.dir_y = static_cast<float>(direction.y());
  ray.dir_z = static_cast<float>(direction.z());
  ray.tfar = static_cast<float>(far);
  ray.mask = ~0U;
  return ray;
}

// Ray number i of four.
template <typename Rays>
void
setRay(Rays& rays,
       int i,
       const Eigen::Vector3d& origin,
       const Eigen::Vector3d& direction,
       double far)
{
  rays.org_x[i] = static_cast<float>(origin.x());
  rays.org_y[i] = static_cast<float>(origin.y());
  rays.org_z[i] = static_cast<float>(origin.z());
  rays.dir_x[i] = static_cast<float>(direction.x());
  rays.dir_y[i] = static_cast<float>(direction.y());
  rays.dir_z[i] = static_cast<float>(direction.z());
  rays.tfar[i] = static_cast<float>(far);
  rays.mask[i] = ~0U;
}

constexpr double infinity = std::numeric_limits<double>::infinity();

} // namespace

struct RayCaster::Impl {
  RTCDevice device = nullptr;
  RTCScene all = nullptr;
  std::vector<RTCScene> alone;
  std::vector<std::vector<Eigen::Vector3d>> vertices; ///< in the world, by thing
  const std::vector<Thing>* things = nullptr;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  ~Impl()
  {
    for (RTCScene scene : alone)
      if (scene != nullptr)
        rtcReleaseScene(scene);
    if (all != nullptr)
      rtcReleaseScene(all);
    if (device != nullptr)
      rtcReleaseDevice(device);
  }

  void
  check(const char* what) const
  {
    const RTCError error = rtcGetDeviceError(device);
    if (error != RTC_ERROR_NONE)
      throw std::runtime_error(std::string("Embree: ") + what + " failed, error " +
                               std::to_string(error));
  }

  RTCScene
  makeScene() const
  {
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    return scene;
  }

  void
  add(std::size_t number, const Thing& thing)
  {
    const Mesh& mesh = *thing.mesh;
    std::vector<Eigen::Vector3d>& world = vertices[number];
    world.reserve(mesh.vertices.size());
    for (const Eigen::Vector3d& vertex : mesh.vertices)
      world.emplace_back(thing.pose * vertex);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(geometry,
                                                               RTC_BUFFER_TYPE_VERTEX,
                                                               0,
                                                               RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float),
                                                               world.size()));
    auto* corners =
        static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(geometry,
                                                            RTC_BUFFER_TYPE_INDEX,
                                                            0,
                                                            RTC_FORMAT_UINT3,
                                                            3 * sizeof(std::uint32_t),
                                                            mesh.triangles.size()));
    check("making a geometry");
    for (const Eigen::Vector3d& vertex : world)
      for (int i = 0; i < 3; ++i)
        *points++ = static_cast<float>(vertex[i]);
    for (const Mesh::Triangle& triangle : mesh.triangles)
      for (const std::uint32_t corner : triangle.corners)
        *corners++ = corner;
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(all, geometry, static_cast<unsigned>(number));
    RTCScene own = nullptr;
    if (thing.annotated) { // nobody asks what clutter would look like alone
      own = makeScene();
      rtcAttachGeometry(own, geometry);
      rtcCommitScene(own);
    }
    alone.push_back(own);
    rtcReleaseGeometry(geometry);
    check("adding a geometry");
  }

  // What Embree found, with the distance that the triangle's plane has.
  Hit
  refine(const Eigen::Vector3d& origin,
         const Eigen::Vector3d& direction,
         unsigned thing,
         unsigned triangle,
         float far,
         float u,
         float v) const
  {
    Hit hit;
    if (thing == RTC_INVALID_GEOMETRY_ID)
      return hit;
    const Mesh::Triangle& found = (*things)[thing].mesh->triangles[triangle];
    const std::vector<Eigen::Vector3d>& points = vertices[thing];
    const Eigen::Vector3d& a = points[found.corners[0]];
    const Eigen::Vector3d normal =
        (points[found.corners[1]] - a).cross(points[found.corners[2]] - a);
    const double slope = normal.dot(direction);
    const double distance = normal.dot(a - origin) / slope;
    hit.thing = static_cast<int>(thing);
    hit.triangle = triangle;
    hit.face = found.face;
    hit.u = u;
    hit.v = v;
    // a sliver seen from its edge has no useful plane
    hit.distance = std::abs(distance - far) < 1e-3 * far ? distance : far;
    hit.normal = (slope > 0 ? -normal : normal).normalized();
    return hit;
  }
};

RayCaster::RayCaster(const Scene& scene) : impl_(std::make_unique<Impl>())
{
  // Embree may end the program over a ray that is not finite
  if (!scene.sensor.camera.valid() || !scene.sensor_to_world.matrix().allFinite())
    throw std::invalid_argument("the camera of '" + scene.name + "' has no numbers");
  // one instruction set and one building thread: the same tree everywhere
  impl_->device = rtcNewDevice("threads=1,set_affinity=0,isa=sse4.2");
  if (impl_->device == nullptr)
    throw std::runtime_error("Embree: no device, error " +
                             std::to_string(rtcGetDeviceError(nullptr)));
  impl_->things = &scene.things;
  impl_->vertices.resize(scene.things.size());
  impl_->all = impl_->makeScene();
  for (std::size_t i = 0; i < scene.things.size(); ++i)
    impl_->add(i, scene.things[i]);
  rtcCommitScene(impl_->all);
  impl_->check("building the scene");
}

RayCaster::~RayCaster() = default;

Hit
RayCaster::cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const
{
  RTCRayHit ray{};
  ray.ray = rayFrom(origin, direction, infinity);
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  intersect(impl_->all, ray);
  return impl_->refine(origin,
                       direction,
                       ray.hit.geomID,
                       ray.hit.primID,
                       ray.ray.tfar,
                       ray.hit.u,
                       ray.hit.v);
}

void
RayCaster::cast4(const Eigen::Vector3d& origin,
                 const Eigen::Vector3d* directions,
                 Hit* hits) const
{
  alignas(16) RTCRayHit4 rays{};
  alignas(16) const int valid[4] = {-1, -1, -1, -1};
  for (int i = 0; i < 4; ++i) {
    setRay(rays.ray, i, origin, directions[i], infinity);
    rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
  }
  intersect(impl_->all, valid, rays);
  for (int i = 0; i < 4; ++i)
    hits[i] = impl_->refine(origin,
                            directions[i],
                            rays.hit.geomID[i],
                            rays.hit.primID[i],
                            rays.ray.tfar[i],
                            rays.hit.u[i],
                            rays.hit.v[i]);
}

bool
RayCaster::blocked(const Eigen::Vector3d& origin,
                   const Eigen::Vector3d& direction,
                   double far) const
{
  RTCRay ray = rayFrom(origin, direction, far);
  occluded(impl_->all, ray);
  return ray.tfar < 0;
}

void
RayCaster::blocked4(const Eigen::Vector3d* origins,
                    const Eigen::Vector3d* directions,
                    const double* fars,
                    bool* blocked) const
{
  alignas(16) RTCRay4 rays{};
  alignas(16) int valid[4];
  for (int i = 0; i < 4; ++i) {
    valid[i] = fars[i] > 0 ? -1 : 0;
    setRay(rays, i, origins[i], directions[i], fars[i]);
  }
  occluded(impl_->all, valid, rays);
  for (int i = 0; i < 4; ++i)
    blocked[i] = valid[i] != 0 && rays.tfar[i] < 0;
}

bool
RayCaster::meets(int thing,
                 const Eigen::Vector3d& origin,
                 const Eigen::Vector3d& direction) const
{
  RTCScene scene = impl_->alone[static_cast<std::size_t>(thing)];
  if (scene == nullptr)
    return false;
  RTCRay ray = rayFrom(origin, direction, infinity);
  occluded(scene, ray);
  return ray.tfar < 0;
}

Eigen::Vector3d
RayCaster::shadingNormal(const Hit& hit) const
{
  const Thing& thing = (*impl_->things)[static_cast<std::size_t>(hit.thing)];
  const Mesh::Triangle& triangle = thing.mesh->triangles[hit.triangle];
  const std::vector<Eigen::Vector3f>& normals = thing.mesh->normals;
  const Eigen::Vector3f n = normals[triangle.corners[0]] * (1 - hit.u - hit.v) +
                            normals[triangle.corners[1]] * hit.u +
                            normals[triangle.corners[2]] * hit.v;
  if (n.squaredNorm() < 1e-6f)
    return hit.normal;
  const Eigen::Vector3d world = thing.pose.linear() * n.cast<double>().normalized();
  const double side = world.dot(hit.normal);
  // where the mesh's normals are off, the triangle's own is better than a black spot
  if (std::abs(side) < 0.2)
    return hit.normal;
  return side < 0 ? Eigen::Vector3d(-world) : world;
}

} // namespace simulation
} // namespace hoist
