#include <hoist/data/ifc/ifc_guid.h>

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <string>

namespace {

using hoist::Uuid;

TEST(IfcGuid, HashesAreThoseOfTheStandard)
{
  // FIPS 180-4's examples, and the lengths around a block's end against each other
  EXPECT_EQ(hoist::sha1Hex("abc"), "a9993e364706816aba3e25717850c26c9cd0d89d");
  EXPECT_EQ(hoist::sha1Hex(""), "da39a3ee5e6b4b0d3255bfef95601890afd80709");
  EXPECT_EQ(hoist::sha1Hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "84983e441c3bd26ebaae4aa1f95129e5e54670f1");
  std::set<std::string> all;
  for (std::size_t n = 0; n < 200; ++n)
    all.insert(hoist::sha1Hex(std::string(n, 'a')));
  EXPECT_EQ(all.size(), 200u);
}

TEST(IfcGuid, UuidOfAName)
{
  // RFC 9562, A.4: version 5 of www.example.com in the name space of DNS
  const Uuid dns = {0x6b,
                    0xa7,
                    0xb8,
                    0x10,
                    0x9d,
                    0xad,
                    0x11,
                    0xd1,
                    0x80,
                    0xb4,
                    0x00,
                    0xc0,
                    0x4f,
                    0xd4,
                    0x30,
                    0xc8};
  const Uuid expected = {0x2e,
                         0xd6,
                         0x65,
                         0x7d,
                         0xe9,
                         0x27,
                         0x56,
                         0x8b,
                         0x95,
                         0xe1,
                         0x26,
                         0x65,
                         0xa8,
                         0xae,
                         0xa6,
                         0xa2};
  EXPECT_EQ(hoist::nameUuid(dns, "www.example.com"), expected);
}

TEST(IfcGuid, ThereAndBack)
{
  std::mt19937 random(7);
  for (int i = 0; i < 1000; ++i) {
    Uuid uuid{};
    for (auto& byte : uuid)
      byte = static_cast<std::uint8_t>(i == 0 ? 0 : i == 1 ? 255 : random());
    const std::string guid = hoist::toIfcGuid(uuid);
    EXPECT_EQ(guid.size(), 22u);
    EXPECT_LE(guid[0], '3'); // two bits
    ASSERT_TRUE(hoist::fromIfcGuid(guid));
    EXPECT_EQ(*hoist::fromIfcGuid(guid), uuid);
  }
  EXPECT_FALSE(hoist::fromIfcGuid("4000000000000000000000")); // 130 bits
  EXPECT_FALSE(hoist::fromIfcGuid("000000000000000000000"));
  EXPECT_FALSE(hoist::fromIfcGuid("00000000000000000000-0"));
}

TEST(IfcGuid, AKeyIsTheSameThingForEver)
{
  const std::string project = hoist::toIfcGuid(Uuid{1, 2, 3});
  EXPECT_EQ(hoist::ifcGuidOf(project, "a"), hoist::ifcGuidOf(project, "a"));
  EXPECT_NE(hoist::ifcGuidOf(project, "a"), hoist::ifcGuidOf(project, "b"));
  EXPECT_NE(hoist::ifcGuidOf(project, "a"), hoist::ifcGuidOf("another", "a"));
  EXPECT_TRUE(hoist::fromIfcGuid(hoist::ifcGuidOf("no GlobalId", "a")));
}

} // namespace
