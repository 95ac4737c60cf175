// The annotation of a frame: what comes back, what is refused, and with which words.
#include "support/real_data.h"
#include "support/truth.h"
#include "temp_folder.h"

#include <hoist/data/annotation.h>
#include <hoist/data/prediction.h>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <pcl/exceptions.h>

#include <cmath>
#include <random>

namespace {

using hoist::AnnotatedObject;
using hoist::annotationFromJson;
using hoist::FrameAnnotation;
using hoist::LoadError;
using hoist::test::TempFolder;
using Json = nlohmann::json;

Eigen::Isometry3d
somePose()
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
  pose.translation() = Eigen::Vector3d(0.1, -2.0 / 3, 1e-17);
  return pose;
}

FrameAnnotation
fullAnnotation()
{
  FrameAnnotation a;
  a.scene = "yard \xc3\xbc 17";
  a.width = 640;
  a.height = 480;
  a.sensor = "stereo";
  a.baseline = 0.24;
  a.seed = 18446744073709551615u;
  a.intrinsics.fx = 525.1;
  a.intrinsics.fy = 524.9;
  a.intrinsics.cx = 319.5;
  a.intrinsics.cy = -1.0 / 3;
  a.distortion = {0.1, -0.2, 1e-4, 0, 0.03};
  a.pose = somePose();
  a.registration = somePose().inverse();
  a.support_plane = Eigen::Vector4d(0, -0.6, -0.8, 1.7);
  a.files = {"f.pcd", "f.jpg", "f.png", "f.instances.png", R"({"left":"f.left.png"})"};
  a.depth_scale = 0.001;
  a.sequence = "way";
  a.visit = 2;
  a.index = 0;
  a.time = 0.0;
  AnnotatedObject box;
  box.label = 1;
  box.object_class = "slab";
  box.center = Eigen::Vector3d(1.0 / 3, -0.1, 3);
  box.size = Eigen::Vector3d(2, 1, 0.2);
  box.rotation = somePose().linear();
  box.difficult = true;
  box.difficult_reasons = {"hidden", "cut"};
  box.box_2d = {1.5, -2, 30, 0};
  box.visible_fraction = 0.3;
  box.visible_pixels = 0;
  box.faces_visible = 2;
  box.observed_faces = {true, false, false, true, false, false};
  box.material = "concrete";
  box.base_rgb = {0, 128, 255};
  box.weight = 960.0;
  box.status = hoist::ObjectStatus::moved;
  box.moved_from = somePose();
  box.global_id = "0YvctVUKr0kugbFTf53O9L";
  box.extra = R"({"mould":[1,2,{"a":null}]})";
  AnnotatedObject bucket = box;
  bucket.label = 65535;
  bucket.is_cuboid = false;
  bucket.object_class = "bucket";
  bucket.symmetry = hoist::ObjectSymmetry::axis1;
  bucket.pose = somePose();
  bucket.fullness = false;
  bucket.status = hoist::ObjectStatus::added;
  bucket.moved_from.reset();
  bucket.extra.clear();
  a.objects = {box, bucket};
  bucket.status = hoist::ObjectStatus::removed;
  bucket.label = 7;
  a.removed = {bucket};
  a.other_objects = {{9, "person", Eigen::Vector3d(0, 0, 4), ""}, {0, "wall", {}, ""}};
  a.extra = R"({"sun":{"height":0.5}})";
  return a;
}

// Every field of the schema, by the text that it makes.
TEST(Annotation, WritesAndReadsEveryField)
{
  const FrameAnnotation a = fullAnnotation();
  const std::string text = hoist::toJson(a);
  const FrameAnnotation b = annotationFromJson(text);
  EXPECT_EQ(hoist::toJson(b), text);
  EXPECT_EQ(hoist::toJson(annotationFromJson(hoist::toJson(a, -1))), text);

  EXPECT_EQ(b.scene, a.scene);
  EXPECT_EQ(b.seed, a.seed);
  EXPECT_EQ(b.distortion, a.distortion);
  EXPECT_EQ(b.pose->matrix(), a.pose->matrix()); // bit for bit
  EXPECT_EQ(b.registration->matrix(), a.registration->matrix());
  EXPECT_EQ(*b.support_plane, *a.support_plane);
  EXPECT_EQ(b.files.instances, "f.instances.png");
  EXPECT_EQ(b.visit, 2);
  EXPECT_EQ(b.index, 0);
  EXPECT_EQ(b.time, 0.0);
  ASSERT_EQ(b.objects.size(), 2u);
  const AnnotatedObject& box = b.objects[0];
  EXPECT_TRUE(box.is_cuboid);
  EXPECT_EQ(box.center, a.objects[0].center);
  EXPECT_EQ(box.rotation, a.objects[0].rotation);
  EXPECT_EQ(box.difficult_reasons.size(), 2u);
  EXPECT_EQ(box.box_2d, a.objects[0].box_2d);
  EXPECT_EQ(box.visible_pixels, 0);
  EXPECT_EQ(box.observed_faces, a.objects[0].observed_faces);
  EXPECT_EQ(box.base_rgb, a.objects[0].base_rgb);
  EXPECT_EQ(box.status, hoist::ObjectStatus::moved);
  EXPECT_EQ(box.moved_from->matrix(), somePose().matrix());
  EXPECT_EQ(Json::parse(box.extra), Json::parse(a.objects[0].extra));
  EXPECT_FALSE(box.fullness);
  EXPECT_FALSE(box.pose);
  const AnnotatedObject& bucket = b.objects[1];
  EXPECT_FALSE(bucket.is_cuboid);
  EXPECT_EQ(bucket.symmetry, hoist::ObjectSymmetry::axis1);
  EXPECT_EQ(bucket.fullness, false);
  ASSERT_EQ(b.removed.size(), 1u);
  EXPECT_FALSE(b.removed[0].is_cuboid);
  ASSERT_EQ(b.other_objects.size(), 2u);
  EXPECT_EQ(b.other_objects[0].center->z(), 4);
  EXPECT_FALSE(b.other_objects[1].center);
  EXPECT_EQ(Json::parse(b.extra), Json::parse(a.extra));
}

TEST(Annotation, WhatIsNotSetStaysAbsent)
{
  FrameAnnotation a;
  a.objects.resize(1);
  a.objects[0].size.setOnes();
  const Json json = Json::parse(hoist::toJson(a));
  for (const auto& [key, value] : json.items())
    EXPECT_TRUE(key == "format" || key == "version" || key == "cuboids" ||
                key == "objects")
        << key;
  for (const auto& [key, value] : json["cuboids"][0].items())
    EXPECT_TRUE(key == "center" || key == "size" || key == "rotation" ||
                key == "difficult")
        << key;
  const FrameAnnotation b = annotationFromJson(json.dump());
  EXPECT_FALSE(b.intrinsics.valid());
  EXPECT_FALSE(b.pose || b.seed || b.visit || b.support_plane);
  EXPECT_FALSE(b.objects[0].weight || b.objects[0].base_rgb || b.objects[0].fullness);
}

TEST(Annotation, NullIsAbsentAndUnknownFieldsAreKept)
{
  const FrameAnnotation a = annotationFromJson(
      R"({"cuboids":[{"center":[0,0,1],"size":[1,1,1],
          "rotation":[[1,0,0],[0,1,0],[0,0,1]],"weight":null,"mean_rgb":[1,2,3]}],
          "pose":null,"objects":null,"weather":"rain"})");
  EXPECT_FALSE(a.pose);
  EXPECT_FALSE(a.objects.at(0).weight);
  const Json again = Json::parse(hoist::toJson(a));
  EXPECT_EQ(again["weather"], "rain");
  EXPECT_EQ(again["cuboids"][0]["mean_rgb"], Json({1, 2, 3}));
  // what the program knows wins over what was kept under the same name
  FrameAnnotation named = a;
  named.extra = R"({"scene":"old"})";
  named.scene = "new";
  EXPECT_EQ(Json::parse(hoist::toJson(named))["scene"], "new");
}

TEST(Annotation, ReadsTheTruthOfTheSampleScenes)
{
  int files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(HOIST_SAMPLES_DIR "/truth")) {
    const FrameAnnotation a = hoist::loadAnnotation(entry.path());
    const hoist::test::Truth truth = hoist::test::loadTruth(entry.path());
    EXPECT_EQ(a.scene, truth.scene);
    EXPECT_EQ(a.intrinsics.fx, truth.intrinsics.fx);
    ASSERT_EQ(a.objects.size(), truth.cuboids.size());
    for (std::size_t i = 0; i < a.objects.size(); ++i) {
      EXPECT_EQ(a.objects[i].center, truth.cuboids[i].cuboid.center);
      EXPECT_EQ(a.objects[i].size, truth.cuboids[i].cuboid.size);
      EXPECT_EQ(a.objects[i].rotation, truth.cuboids[i].cuboid.axes);
      EXPECT_EQ(a.objects[i].difficult, truth.cuboids[i].difficult);
      EXPECT_EQ(a.objects[i].visible_fraction, truth.cuboids[i].visible_fraction);
      EXPECT_TRUE(a.objects[i].base_rgb && a.objects[i].visible_pixels);
    }
    ASSERT_TRUE(a.support_plane);
    EXPECT_NEAR(a.support_plane->head<3>().norm(), 1, 1e-12);
    EXPECT_GE((*a.support_plane)[3], 0);
    ++files;
  }
  EXPECT_EQ(files, 6);
}

TEST(Annotation, ReadsTheTruthOfRealScenes)
{
  HOIST_SKIP_WITHOUT_REAL_DATA();
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(
           *hoist::test::realData() / "mosd" / "gt"))
    if (entry.path().extension() == ".json") {
      const FrameAnnotation a = hoist::loadAnnotation(entry.path());
      EXPECT_EQ(a.objects.size(), hoist::test::loadTruth(entry.path()).cuboids.size());
      const std::string text = hoist::toJson(a);
      EXPECT_EQ(hoist::toJson(annotationFromJson(text)), text);
      ++files;
    }
  EXPECT_EQ(files, 78);
}

TEST(Annotation, FilesAreNamedByTheirStemAndWrittenWhole)
{
  const TempFolder folder;
  FrameAnnotation a = fullAnnotation();
  hoist::saveAnnotation(folder.name("full.json"), a);
  EXPECT_EQ(hoist::toJson(hoist::loadAnnotation(folder.name("full.json"))),
            hoist::toJson(a));
  EXPECT_EQ(hoist::loadAnnotation(folder.write("a.b.json", R"({"objects":[]})")).scene,
            "a.b");
  EXPECT_THROW(hoist::loadAnnotation(folder.name("none.json")), LoadError);
  EXPECT_THROW(hoist::loadAnnotation(folder.path()), LoadError);
  EXPECT_THROW(hoist::saveAnnotation(folder.name("no/such/folder.json"), a),
               pcl::IOException);
}

TEST(Annotation, RefusesToWriteWhatNoReaderTakes)
{
  FrameAnnotation a = fullAnnotation();
  a.objects[0].center.x() = std::nan("");
  EXPECT_THROW(hoist::toJson(a), pcl::BadArgumentException);
  a = fullAnnotation();
  a.time = INFINITY;
  EXPECT_THROW(hoist::toJson(a), pcl::BadArgumentException);
  for (const char* const extra : {"[1]", "3", "{", "{\"a\":"}) {
    a = fullAnnotation();
    a.objects[0].extra = extra;
    EXPECT_THROW(hoist::toJson(a), pcl::BadArgumentException) << extra;
  }
}

// ------------------------------------------------------------------- what is wrong

struct Wrong {
  const char* pointer; ///< where, as a JSON pointer
  const char* value;   ///< what is put there
  const char* position;
  const char* reason;
};

const Wrong wrongs[] = {
    {"/cuboids/0/size",
     "[1,2]",
     "cuboids[0].size",
     "three numbers, found an array of 2"},
    {"/cuboids/0/size", "[1,0,2]", "cuboids[0].size", "three positive numbers"},
    {"/cuboids/0/size/1", "\"x\"", "cuboids[0].size[1]", "a number, found \"x\""},
    {"/cuboids/0/center", "{}", "cuboids[0].center", "three numbers, found an object"},
    {"/cuboids/0/center/2", "null", "cuboids[0].center[2]", "a number, found null"},
    {"/cuboids/0/rotation", "[1,0,0,0,1,0,0,0,1]", "cuboids[0].rotation", "three rows"},
    {"/cuboids/0/rotation/0/0", "2", "cuboids[0].rotation", "not orthonormal"},
    {"/cuboids/0/rotation/0/0", "1e300", "cuboids[0].rotation", "not orthonormal"},
    {"/cuboids/0/label", "1.5", "cuboids[0].label", "a whole number from 0 to 65535"},
    {"/cuboids/0/label", "70000", "cuboids[0].label", "from 0 to 65535, found 70000"},
    {"/cuboids/0/label",
     "18446744073709551615",
     "cuboids[0].label",
     "found 1844674407"},
    {"/cuboids/0/difficult", "1", "cuboids[0].difficult", "true or false, found 1"},
    {"/cuboids/0/class", "3", "cuboids[0].class", "a text, found 3"},
    {"/cuboids/0/symmetry",
     "\"round\"",
     "cuboids[0].symmetry",
     "\"axis 0\", \"axis 1\""},
    {"/cuboids/0/status", "\"gone\"", "cuboids[0].status", "\"new\", \"moved\""},
    {"/cuboids/0/visible_fraction",
     "1.1",
     "cuboids[0].visible_fraction",
     "from 0.0 to 1"},
    {"/cuboids/0/base_rgb", "[1,2,256]", "cuboids[0].base_rgb[2]", "from 0 to 255"},
    {"/cuboids/0/observed_faces", "[true]", "cuboids[0].observed_faces", "six of true"},
    {"/cuboids/0/box_2d", "[0,0,-1,2]", "cuboids[0].box_2d[2]", "at least 0"},
    {"/cuboids/0/weight", "-1", "cuboids[0].weight", "at least 0"},
    {"/cuboids/0/moved_from", "{}", "cuboids[0].moved_from", "\"rotation\" is missing"},
    {"/cuboids/0", "7", "cuboids[0]", "an object, found 7"},
    {"/cuboids", "{}", "cuboids", "an array, found an object"},
    {"/objects/0/label", "1", "", "label 1 is given to two objects"},
    {"/removed/0/size", "null", "removed[0]", "\"size\" is missing"},
    {"/other_objects/0/center", "[1]", "other_objects[0].center", "three numbers"},
    {"/intrinsics/fx", "-1", "intrinsics.fx", "at least 0"},
    {"/intrinsics", "{\"fx\":1}", "intrinsics", "\"fy\" is missing"},
    {"/distortion", "[1,2,3]", "distortion", "4, 5, 8, 12 or 14 numbers"},
    {"/pose/rotation/0/0", "\"a\"", "pose.rotation[0][0]", "a number"},
    {"/pose/rotation", "[[-1,0,0],[0,1,0],[0,0,1]]", "pose.rotation", "left-handed"},
    {"/support_plane", "[0,0,1]", "support_plane", "four numbers"},
    {"/seed", "-1", "seed", "a whole number from 0"},
    {"/visit", "0", "visit", "from 1"},
    {"/files/depth", "[]", "files.depth", "a text"},
    {"/format", "\"COCO\"", "format", "\"hoist annotation\""},
    {"/version", "2", "version", "newer"},
};

TEST(Annotation, SaysWhereAndWhatIsWrong)
{
  const Json good = Json::parse(hoist::toJson(fullAnnotation()));
  for (const Wrong& wrong : wrongs) {
    Json bad = good;
    bad[Json::json_pointer(wrong.pointer)] = Json::parse(wrong.value);
    try {
      annotationFromJson(bad.dump(), "yard.json");
      ADD_FAILURE() << wrong.pointer << " = " << wrong.value << " was taken";
    }
    catch (const LoadError& error) {
      EXPECT_EQ(error.file(), "yard.json");
      EXPECT_EQ(error.position(), wrong.position) << wrong.pointer;
      EXPECT_NE(error.reason().find(wrong.reason), std::string::npos)
          << wrong.pointer << ": " << error.reason();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
}

TEST(Annotation, WhatIsNoAnnotationIsNamed)
{
  for (const char* const text : {"",
                                 "{}",
                                 "[]",
                                 "3",
                                 "null",
                                 "{\"cuboids\":null}",
                                 "{\"cuboids\":[}",
                                 "{\"cuboids\":[]} x",
                                 "\xff\xfe",
                                 "{\"cuboids\":[{\"center\":[1e999,0,0]}]}"})
    EXPECT_THROW(annotationFromJson(text, "x.json"), LoadError) << text;
  EXPECT_NO_THROW(annotationFromJson("{\"cuboids\":[]}"));
}

TEST(Annotation, CutAnywhereItIsRefused)
{
  const std::string text = hoist::toJson(fullAnnotation(), -1);
  for (std::size_t n = 0; n + 2 < text.size(); ++n) // the last byte ends the line
    EXPECT_THROW(annotationFromJson(text.substr(0, n)), LoadError) << n;
}

// Bytes are changed at random: it is read or refused, and what is read can be written.
TEST(Annotation, ChangedAnywhereItIsReadOrRefused)
{
  const std::string good = hoist::toJson(fullAnnotation(), -1);
  const std::string bytes = "0123456789eE.-+[]{}\",:ntf \\\xff";
  std::mt19937 random(11);
  int refused = 0, read = 0;
  for (int i = 0; i < 4000; ++i) {
    std::string text = good;
    for (std::size_t k = 1 + random() % 3; k > 0; --k)
      text[random() % text.size()] = bytes[random() % bytes.size()];
    try {
      const FrameAnnotation a = annotationFromJson(text);
      const std::string again = hoist::toJson(a);
      EXPECT_EQ(hoist::toJson(annotationFromJson(again)), again);
      ++read;
    }
    catch (const LoadError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 100);
  EXPECT_GT(read, 100);
}

/** Where every value lies, containers as well as what is in them. */
void
collectPointers(const Json& value,
                const Json::json_pointer& here,
                std::vector<Json::json_pointer>& pointers)
{
  pointers.push_back(here);
  if (value.is_object())
    for (const auto& [key, inner] : value.items())
      collectPointers(inner, here / key, pointers);
  if (value.is_array())
    for (std::size_t i = 0; i < value.size(); ++i)
      collectPointers(value[i], here / i, pointers);
}

// Every value in turn becomes one of another type.
TEST(Annotation, AnyTypeAnywhereIsReadOrRefused)
{
  const Json good = Json::parse(hoist::toJson(fullAnnotation()));
  std::vector<Json::json_pointer> pointers;
  collectPointers(good, Json::json_pointer(), pointers);
  EXPECT_GT(pointers.size(), good.flatten().size()); // more than the leaves
  for (const Json::json_pointer& pointer : pointers)
    for (const char* const other :
         {"null", "true", "-3", "1e308", "\"\"", "[]", "{}", "[[[]]]"}) {
      Json bad = good;
      bad[pointer] = Json::parse(other);
      for (const std::string& text : {bad.dump(), Json::array({bad}).dump()}) {
        try {
          annotationFromJson(text);
        }
        catch (const LoadError&) {
        }
        try {
          hoist::predictionsFromJson(text);
        }
        catch (const LoadError&) {
        }
      }
    }
}

TEST(Annotation, HostileTextsEndSoon)
{
  // a reader that recurses, or that takes quadratic time for keys, does not get through
  const std::string deep(5000000, '[');
  EXPECT_THROW(annotationFromJson(deep), LoadError);
  std::string nested = "{\"cuboids\":[],\"x\":";
  nested += std::string(99, '[') + std::string(99, ']') + "}";
  EXPECT_NO_THROW(hoist::toJson(annotationFromJson(nested)));
  // brackets in a text are no nesting
  EXPECT_NO_THROW(annotationFromJson("{\"cuboids\":[],\"x\":\"" +
                                     std::string(200, '[') + "\\\"[\"}"));
  std::string keys = "{\"cuboids\":[]";
  for (int i = 0; i < 300000; ++i)
    keys += ",\"k" + std::to_string(i) + "\":0";
  EXPECT_NO_THROW(annotationFromJson(keys + "}"));
}

// ------------------------------------------------------------------------- results

TEST(Prediction, WrongEntriesAreLeftOutAndTold)
{
  const std::string axes = "\"rotation\":[[1,0,0],[0,1,0],[0,0,1]]";
  const auto frames = hoist::predictionsFromJson(
      "{\"scene\":\"s\",\"cuboids\":[{\"center\":[0,0,1],\"size\":[1,1,1]," + axes +
          "},{\"center\":[0,0,1],\"size\":[1,-1,1]," + axes + "},{\"center\":[0,0,1]," +
          axes + "},{\"center\":[0,0,1],\"size\":[1,1,1],\"score\":\"high\"," + axes +
          "},{\"center\":[0,0,2],\"size\":[1,1,1],\"score\":0.25,\"features\":{\"rgb\":"
          "[1,2,3],\"material\":\"wood\",\"weight\":0},\"size_sigma\":[0.1,null,0.2]," +
          axes + "}]}",
      "r.json");
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].scene, "s");
  ASSERT_EQ(frames[0].predictions.size(), 2u);
  EXPECT_EQ(frames[0].predictions[0].score, 1);
  const hoist::Prediction& second = frames[0].predictions[1];
  EXPECT_EQ(second.score, 0.25);
  EXPECT_EQ(second.rgb, (std::array<int, 3>{1, 2, 3}));
  EXPECT_EQ(second.material, "wood");
  EXPECT_FALSE(second.weight); // 0 is "not known" in results
  EXPECT_TRUE(std::isnan(second.size_sigma[1]));
  EXPECT_EQ(second.size_sigma[2], 0.2);
  ASSERT_EQ(frames[0].skipped.size(), 3u);
  EXPECT_NE(frames[0].skipped[0].find("r.json:cuboids[1].size"), std::string::npos);
  EXPECT_NE(frames[0].skipped[1].find("\"size\" is missing"), std::string::npos);
  EXPECT_NE(frames[0].skipped[2].find("cuboids[3].score"), std::string::npos);
}

TEST(Prediction, AnArrayIsManyFramesAndNothingElseIsTaken)
{
  EXPECT_EQ(hoist::predictionsFromJson(R"([{"cuboids":[]},{"objects":[]}])").size(),
            2u);
  for (const char* const text : {"{}", "3", "[3]", "", "[{\"cuboids\":3}]"})
    EXPECT_THROW(hoist::predictionsFromJson(text), LoadError) << text;
}

} // namespace
