// Flat pieces of a frame: their planes against analytic ones, creases where planes
// meet, masks, empty frames.
#include <hoist/segmentation/face_borders.h>
#include <hoist/segmentation/planar_faces.h>

#include "allocations.h"
#include "test_full_frames.h"

#include <Eigen/Cholesky>

#include <gtest/gtest.h>

#include <cmath>

namespace hoist {
namespace {

using Planes = std::vector<Eigen::Vector3d>; // (a, b, c) of 1/z = a u + b v + c

struct PlaneImage {
  cv::Mat1f inverse_depth;
  cv::Mat1i plane;
};

constexpr int width = 160, height = 120;

Intrinsics
camera()
{
  Intrinsics c;
  c.fx = c.fy = 262.5;
  c.cx = (width - 1) / 2.0;
  c.cy = (height - 1) / 2.0;
  return c;
}

Eigen::Vector3d
toPixels(const Eigen::Vector3d& normal, double distance)
{
  return test::trueFace(normal.normalized(), distance * normal.normalized(), camera())
      .inverse_depth;
}

// Each pixel shows the farthest of the planes: they meet convexly, as on a box.
PlaneImage
draw(const Planes& planes,
     double noise,
     std::uint64_t seed,
     const SensorModel& sensor = {})
{
  PlaneImage image;
  image.inverse_depth.create(height, width);
  image.plane.create(height, width);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      double w = std::numeric_limits<double>::max();
      for (std::size_t i = 0; i < planes.size(); ++i) {
        const double wi = planes[i][0] * u + planes[i][1] * v + planes[i][2];
        if (wi < w) {
          w = wi;
          image.plane(v, u) = static_cast<int>(i);
        }
      }
      const double z =
          1 / w + noise * sensor.sigmaZ(1 / w) * samples::hashNormal(seed, u, v);
      image.inverse_depth(v, u) = static_cast<float>(1 / z);
    }
  return image;
}

// Three faces of a corner that points at the camera.
Planes
corner(std::uint64_t seed)
{
  samples::Random random(seed);
  const double z = random.uniform(0.8, 1.6);
  const Eigen::Vector3d apex =
      z * camera().ray(random.uniform(60, 100), random.uniform(45, 75));
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(random.uniform(0, 6.28), Eigen::Vector3d::UnitZ()) *
       Eigen::AngleAxisd(random.uniform(-0.15, 0.15), Eigen::Vector3d::UnitX()) *
       Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d(1, 1, 1),
                                          -Eigen::Vector3d::UnitZ()))
          .toRotationMatrix();
  Planes planes;
  for (int i = 0; i < 3; ++i)
    planes.push_back(test::trueFace(turn.col(i), apex, camera()).inverse_depth);
  return planes;
}

struct Found {
  cv::Mat1s labels;
  std::vector<PlanarFace> faces;
};

Found
find(const cv::Mat1f& image, const cv::Mat1b& mask = {})
{
  PlanarFaceFinder finder;
  Found found;
  finder.find(image, mask, camera(), {}, found.labels, found.faces);
  return found;
}

// The face that most pixels of a true plane belong to.
int
faceOf(const PlaneImage& image, const Found& found, int plane)
{
  std::vector<int> votes(found.faces.size() + 1, 0);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      if (image.plane(v, u) == plane)
        ++votes[found.labels(v, u)];
  return static_cast<int>(std::max_element(votes.begin(), votes.end()) -
                          votes.begin()) -
         1;
}

// Distance of a pixel from the nearest line where two planes have equal depth.
double
creaseDistance(const Planes& planes, int u, int v, int own)
{
  double nearest = 1e9;
  for (int k = 0; k < static_cast<int>(planes.size()); ++k) {
    if (k == own)
      continue;
    const Eigen::Vector3d d = planes[k] - planes[own];
    nearest = std::min(nearest,
                       std::abs(d[0] * u + d[1] * v + d[2]) / std::hypot(d[0], d[1]));
  }
  return nearest;
}

TEST(PlanarFaces, ExactPlanesComeBackAndCreasesLieWherePlanesMeet)
{
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Planes planes = corner(seed);
    const PlaneImage image = draw(planes, 0, 0);
    const Found found = find(image.inverse_depth);
    ASSERT_EQ(found.faces.size(), 3U) << "seed " << seed;
    for (int i = 0; i < 3; ++i) {
      const int face = faceOf(image, found, i);
      ASSERT_GE(face, 0);
      const PlanarFace& f = found.faces[face];
      double worst = 0;
      for (int v = 0; v < height; ++v)
        for (int u = 0; u < width; ++u) {
          if (image.plane(v, u) != i)
            continue;
          ASSERT_GT(found.labels(v, u), 0)
              << "seed " << seed << " at " << u << " " << v;
          if (found.labels(v, u) != face + 1) {
            EXPECT_LT(creaseDistance(planes, u, v, i), 1.0) << "seed " << seed;
          }
          const Eigen::Vector3d pixel(u, v, 1);
          worst = std::max(worst,
                           std::abs((f.inverse_depth - planes[i]).dot(pixel)) /
                               planes[i].dot(pixel));
        }
      // a float has 24 bits and thousands of pixels average out
      EXPECT_LT(worst, 1e-7) << "seed " << seed;
    }
  }
}

TEST(PlanarFaces, NoisyPlanesComeBackWithinTheErrorOfTheFit)
{
  const SensorModel sensor;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Planes planes = corner(seed);
    const PlaneImage image = draw(planes, 1, seed);
    const Found found = find(image.inverse_depth);
    ASSERT_EQ(found.faces.size(), 3U) << "seed " << seed;
    int labelled = 0;
    for (int v = 0; v < height; ++v)
      for (int u = 0; u < width; ++u)
        labelled += found.labels(v, u) > 0 ? 1 : 0;
    // of normal errors 0.3 % lie beyond pixel_tolerance = 3 sigma
    EXPECT_GT(labelled, 0.996 * width * height) << "seed " << seed;
    for (int i = 0; i < 3; ++i) {
      const PlanarFace& f = found.faces[faceOf(image, found, i)];
      Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
      std::vector<Eigen::Vector3d> pixels;
      for (int v = 0; v < height; ++v)
        for (int u = 0; u < width; ++u)
          if (image.plane(v, u) == i) {
            const Eigen::Vector3d p(u, v, 1);
            const double w = planes[i].dot(p), s = sensor.sigmaZ(1 / w) * w * w;
            normal += p * p.transpose() / (s * s);
            pixels.push_back(p);
          }
      const Eigen::Matrix3d covariance = normal.inverse();
      double worst = 0;
      for (const Eigen::Vector3d& p : pixels)
        worst = std::max(worst,
                         std::abs((f.inverse_depth - planes[i]).dot(p)) /
                             std::sqrt(p.dot(covariance * p)));
      // The farthest pixel is off by sigma * chi with three degrees of freedom: 4.5 is
      // exceeded once in 7000. Creases and equal weights may add some.
      EXPECT_LT(worst, 5) << "seed " << seed;
    }
  }
}

TEST(PlanarFaces, DescribesThePlaneInSpace)
{
  const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.4, -1).normalized();
  const Planes planes = {toPixels(normal, -1.3)};
  const Found found = find(draw(planes, 0, 0).inverse_depth);
  ASSERT_EQ(found.faces.size(), 1U);
  const PlanarFace& f = found.faces[0];
  EXPECT_LT((f.normal - normal).norm(), 1e-5);
  EXPECT_NEAR(f.offset, 1.3, 1e-5);
  EXPECT_NEAR(f.normal.dot(f.centroid) + f.offset, 0, 1e-9);
  EXPECT_EQ(f.pixels, width * height);
  EXPECT_EQ(f.box, cv::Rect(0, 0, width, height));
  EXPECT_LT(f.rms, 0.1);
  // the footprint against the difference of two neighbouring rays
  const Eigen::Vector2d q = camera().project(f.centroid);
  const auto on = [&](double u, double v) {
    const Eigen::Vector3d ray = camera().ray(u, v);
    return Eigen::Vector3d(ray * (-f.offset / f.normal.dot(ray)));
  };
  const Eigen::Vector3d d = f.normal.unitOrthogonal();
  constexpr double h = 1e-3;
  const double du = d.dot(on(q.x() + h, q.y()) - on(q.x() - h, q.y())) / (2 * h);
  const double dv = d.dot(on(q.x(), q.y() + h) - on(q.x(), q.y() - h)) / (2 * h);
  EXPECT_NEAR(footprint(f, d, camera()), std::hypot(du, dv), 1e-6);
}

TEST(PlanarFaces, NormalSigmaIsTheSpreadForFiftyCorrelatedPixels)
{
  // The noise here is independent, sigma speaks of depths of which 50 count as one.
  const Eigen::Vector3d normal = Eigen::Vector3d(0.2, -0.3, -1).normalized();
  const Planes planes = {toPixels(normal, -1.2)};
  double square = 0, sigma = 0;
  constexpr int n = 20;
  for (int seed = 0; seed < n; ++seed) {
    const Found found = find(draw(planes, 1, seed).inverse_depth);
    ASSERT_EQ(found.faces.size(), 1U);
    const double angle = found.faces[0].normal.cross(normal).norm();
    square += angle * angle / n;
    sigma += found.faces[0].normal_sigma / n;
  }
  const double ratio = std::sqrt(50 * square) / sigma;
  EXPECT_GT(ratio, 0.6); // 20 draws tell a spread to a sixth
  EXPECT_LT(ratio, 1.6);
}

TEST(PlanarFaces, NothingOutsideTheMask)
{
  const Planes planes = corner(3);
  const PlaneImage image = draw(planes, 1, 3);
  cv::Mat1b mask(height, width, static_cast<unsigned char>(0));
  mask(cv::Rect(37, 22, 81, 63)).setTo(255);
  const Found masked = find(image.inverse_depth, mask);
  ASSERT_FALSE(masked.faces.empty());
  cv::Mat1f cut = image.inverse_depth.clone();
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      if (mask(v, u) == 0) {
        EXPECT_EQ(masked.labels(v, u), 0);
        cut(v, u) = 0;
      }
  // the same as if the rest had not been measured
  const Found alone = find(cut);
  EXPECT_EQ(cv::norm(masked.labels, alone.labels, cv::NORM_INF), 0);
  EXPECT_EQ(masked.faces.size(), alone.faces.size());
}

TEST(PlanarFaces, LabelsCountThePixelsOfTheFaces)
{
  const Found found = find(draw(corner(5), 1, 5).inverse_depth);
  std::vector<int> count(found.faces.size(), 0);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      const int label = found.labels(v, u);
      ASSERT_LE(label, static_cast<int>(found.faces.size()));
      if (label > 0) {
        ++count[label - 1];
        EXPECT_TRUE(found.faces[label - 1].box.contains({u, v}));
      }
    }
  for (std::size_t i = 0; i < count.size(); ++i)
    EXPECT_EQ(count[i], found.faces[i].pixels);
}

TEST(PlanarFaces, AFaceIsTheLeastSquaresPlaneOfItsPixels)
{
  // Sums of whole cells, of shared cells and of what is left beside the last cell make
  // the same plane as all pixels one by one.
  cv::Mat1f image =
      draw(corner(6), 1, 6).inverse_depth(cv::Rect(0, 0, 157, 118)).clone();
  for (int v = 0; v < image.rows; ++v)
    for (int u = 0; u < image.cols; ++u)
      if (samples::hashNormal(9, u, v) > 1.5) // one pixel in fifteen is not measured
        image(v, u) = 0;
  const Found found = find(image);
  ASSERT_GE(found.faces.size(), 3U);
  for (std::size_t i = 0; i < found.faces.size(); ++i) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    double square = 0;
    cv::Point low(width, height), high(-1, -1);
    const PlanarFace& face = found.faces[i];
    for (int v = 0; v < image.rows; ++v)
      for (int u = 0; u < image.cols; ++u) {
        if (found.labels(v, u) != static_cast<short>(i + 1))
          continue;
        ASSERT_GT(image(v, u), 0);
        const Eigen::Vector3d p(u, v, 1);
        normal += p * p.transpose();
        right += p * image(v, u);
        square += std::pow(image(v, u) - face.inverse_depth.dot(p), 2);
        low = {std::min(low.x, u), std::min(low.y, v)};
        high = {std::max(high.x, u), std::max(high.y, v)};
      }
    const Eigen::Vector3d plane = normal.ldlt().solve(right);
    for (const Eigen::Vector2d& corner :
         {Eigen::Vector2d(low.x, low.y), Eigen::Vector2d(high.x, high.y)})
      // cells keep their means as floats, rounded to 6e-8, of which many average out
      EXPECT_NEAR((plane - face.inverse_depth).dot(corner.homogeneous()), 0, 2e-8);
    EXPECT_EQ(face.box, cv::Rect(low, high + cv::Point(1, 1)));
    // rms is in units of sigma at the mean inverse depth
    const double w = right.z() / face.pixels, z = 1 / w;
    PlanarFaceFinder finder;
    Found again;
    finder.find(image, {}, camera(), {}, again.labels, again.faces);
    const double sigma = finder.noiseScale() * SensorModel().sigmaZ(z) * w * w;
    EXPECT_NEAR(face.rms, std::sqrt(square / face.pixels) / sigma, 1e-3);
  }
}

TEST(PlanarFaces, MemoryIsKeptFromFrameToFrame)
{
  PlanarFaceFinder finder;
  FaceBorders borders;
  Found found;
  const PlaneImage image = draw(corner(4), 1, 4);
  cv::Mat1b mask(height, width, static_cast<unsigned char>(255));
  mask(cv::Rect(30, 20, 9, 50)).setTo(0);
  const auto run = [&](const cv::Mat1b& use) {
    finder.find(image.inverse_depth, use, camera(), {}, found.labels, found.faces);
    findFaceBorders(
        found.labels, image.inverse_depth, use, camera(), {}, found.faces, borders);
  };
  for (const cv::Mat1b& use : {cv::Mat1b(), mask}) {
    run(use);
    const std::size_t before = test::allocations();
    run(use);
    EXPECT_EQ(test::allocations() - before, 0U) << (use.empty() ? "no mask" : "mask");
  }
}

TEST(PlanarFaces, SecondCallEqualsTheFirst)
{
  const PlaneImage image = draw(corner(7), 1, 7);
  PlanarFaceFinder finder;
  Found first, other, second;
  const auto run = [&](const cv::Mat1f& w, Found& out) {
    finder.find(w, {}, camera(), {}, out.labels, out.faces);
  };
  run(image.inverse_depth, first);
  run(draw(corner(8), 0, 8).inverse_depth(cv::Rect(0, 0, 101, 67)), other);
  run(image.inverse_depth, second);
  EXPECT_EQ(cv::norm(first.labels, second.labels, cv::NORM_INF), 0);
  ASSERT_EQ(first.faces.size(), second.faces.size());
  for (std::size_t i = 0; i < first.faces.size(); ++i) {
    EXPECT_EQ(first.faces[i].inverse_depth, second.faces[i].inverse_depth);
    EXPECT_EQ(first.faces[i].normal, second.faces[i].normal);
    EXPECT_EQ(first.faces[i].rms, second.faces[i].rms);
  }
}

TEST(PlanarFaces, NoFacesWithoutMeasurements)
{
  cv::Mat1f nothing(height, width, 0.0F);
  EXPECT_TRUE(find(nothing).faces.empty());
  EXPECT_EQ(cv::countNonZero(find(nothing).labels), 0);
  EXPECT_TRUE(find(cv::Mat1f()).faces.empty());
  cv::Mat1f tiny(3, 3, 1.0F); // less than a cell
  EXPECT_TRUE(find(tiny).faces.empty());
  cv::Mat1f full(height, width, 1.0F);
  EXPECT_TRUE(find(full, cv::Mat1b(height, width, static_cast<unsigned char>(0)))
                  .faces.empty());
}

TEST(PlanarFaces, ASphereIsNotOneFace)
{
  cv::Mat1f image(height, width, 0.0F);
  const Eigen::Vector3d center(0, 0, 1.0);
  constexpr double radius = 0.25;
  int pixels = 0;
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      const Eigen::Vector3d ray = camera().ray(u, v);
      const double b = ray.dot(center), a = ray.squaredNorm();
      const double root = b * b - a * (center.squaredNorm() - radius * radius);
      if (root < 0)
        continue;
      image(v, u) = static_cast<float>(a / (b - std::sqrt(root)));
      ++pixels;
    }
  for (const PlanarFace& face : find(image).faces)
    EXPECT_LT(face.pixels, pixels / 2);
}

TEST(PlanarFaces, NoiseScaleFollowsTheFrame)
{
  PlanarFaceFinder finder;
  Found out;
  const auto scale = [&](double noise) {
    finder.find(draw(corner(2), noise, 2).inverse_depth,
                {},
                camera(),
                {},
                out.labels,
                out.faces);
    return finder.noiseScale();
  };
  EXPECT_DOUBLE_EQ(scale(0), 0.05); // the documented floor
  EXPECT_DOUBLE_EQ(scale(1), 1);    // and ceiling
  const double low = scale(0.1), high = scale(0.3);
  // twice the lower quartile of the windows, which is just below the noise itself
  EXPECT_NEAR(low, 0.2, 0.04);
  EXPECT_NEAR(high, 0.6, 0.12);
}

TEST(PlanarFaces, TheNoiseOfEverySensorIsKnown)
{
  // Twice the lower quartile of the windows as above, and planes at 0.7 to 2 m, so that
  // a sensor taken for another one would be off by more than the tolerance.
  for (const SensorModel& sensor : {SensorModel::kinect(),
                                    SensorModel::stereo(60, 0.2),
                                    SensorModel::constant(0.004)}) {
    PlanarFaceFinder finder;
    Found out;
    PlanarFaceParameters parameters;
    parameters.sensor = sensor;
    for (const double distance : {0.7, 2.0}) {
      const Planes planes = {toPixels(Eigen::Vector3d(0.2, -0.3, -1), -distance)};
      finder.find(draw(planes, 0.3, 2, sensor).inverse_depth,
                  {},
                  camera(),
                  parameters,
                  out.labels,
                  out.faces);
      EXPECT_NEAR(finder.noiseScale(), 0.6, 0.12) << distance;
      ASSERT_EQ(out.faces.size(), 1U);
      EXPECT_GT(out.faces[0].pixels, 0.99 * width * height);
    }
  }
}

} // namespace
} // namespace hoist
