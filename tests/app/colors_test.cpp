#include "../../app/colors.h"

#include <gtest/gtest.h>

namespace dupin::app {
namespace {

TEST(Colors, HexAndNamesAndNumbersAreRead) {
  EXPECT_EQ(parse_color("white"), (Color{1, 1, 1, 1}));
  EXPECT_EQ(parse_color("#ffffff"), (Color{1, 1, 1, 1}));
  EXPECT_EQ(parse_color("#f00"), (Color{1, 0, 0, 1}));
  EXPECT_EQ(parse_color("1,0,0"), (Color{1, 0, 0, 1}));
  EXPECT_EQ(parse_color("#0000ff00"), (Color{0, 0, 1, 0}));
}

TEST(Colors, WhatPeopleWriteIsSrgbAndWhatIsKeptIsLinear) {
  EXPECT_NEAR(parse_color("gray")->r, 0.21586, 1e-5);  // IEC 61966-2-1 of 128/255
}

TEST(Colors, HexOfAParsedColorIsTheSameAgain) {
  for (const char* text : {"#000000", "#010203", "#7f8081", "#fedcba", "#12345678"})
    EXPECT_EQ(hex_color(*parse_color(text)), text);
}

TEST(Colors, NonsenseIsRefused) {
  for (const char* text :
       {"", "octarine", "#12", "#12345", "#ggg", "1,2,3", "0.1,0.2", "0,0,0,0", "nan,0,0", "#"})
    EXPECT_FALSE(parse_color(text)) << text;
}

TEST(Colors, AFacesOwnColorWinsThenTheInstancesThenTheParts) {
  Part part;
  Instance instance;
  Face face;
  EXPECT_FALSE(file_color(face, instance, part));
  part.color = Color{1, 0, 0, 1};
  EXPECT_EQ(file_color(face, instance, part), part.color);
  instance.color = Color{0, 1, 0, 1};
  EXPECT_EQ(file_color(face, instance, part), instance.color);
  face.color = Color{0, 0, 1, 1};
  EXPECT_EQ(file_color(face, instance, part), face.color);
}

}  // namespace
}  // namespace dupin::app
