// What a host changes about a scene: what is visible, in which color, highlighted, and where.
#include "../../render/view.h"
#include "device.h"

namespace dupin::testing {
namespace {

Camera camera_for(const HandMade& made) {
  Camera camera;
  camera.width = 480;
  camera.height = 360;
  Box3 box;
  for (const Instance& instance : made.model.instances)
    box.add(transform_box(instance.to_world, made.model.parts[instance.part].box));
  return *fit_view(box, "iso", camera);
}

const Affine3 kAside = rigid({0, 0, 1}, 0.4, {2.5, 1, 0.5});

/// Every kind of primitive, twice; and a part of triangles.
HandMade two_of_every_kind() {
  HandMade made = every_kind();
  made.place({});
  made.place(kAside);
  made.model.parts.emplace_back();
  made.dps.parts.emplace_back();
  Part& part = made.model.parts[1];
  part.mesh.positions = {{0, -5, 1}, {4, -5, 1}, {4, -3, 1}, {0, -3, 1}, {4, -5, 4}, {4, -3, 4}};
  part.mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {1, 0, 0}, {1, 0, 0}};
  part.mesh.triangles = {0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2};
  part.mesh.faces = {0, 0, 0, 0};
  for (const auto& p : part.mesh.positions) part.box.add(Vec3{p[0], p[1], p[2]});
  made.model.instances.emplace_back();
  made.model.instances.back().part = 1;
  return made;
}

DrawOptions numbers_and_colors(Shading shading = Shading::lit) {
  DrawOptions options;
  options.outputs = kColor | kScreen | kFace | kDepth;
  options.shading = shading;
  return options;
}

class Looks : public ::testing::Test {
 protected:
  HandMade made_ = two_of_every_kind();
  Camera camera_ = camera_for(made_);
  TestDevice gl_;
  std::unique_ptr<Scene> scene_ = gl_.upload(made_);
  Frame draw(const DrawOptions& options = numbers_and_colors()) {
    return gl_.draw(*scene_, camera_, options);
  }
  Frame draw_other(const HandMade& made, const DrawOptions& options = numbers_and_colors()) {
    const auto scene = gl_.upload(made);
    return gl_.draw(*scene, camera_, options);
  }
  std::uint32_t number_of(std::uint32_t instance, std::uint32_t face) {
    for (std::uint32_t n = 1; n <= scene_->info().drawn_faces; ++n) {
      const FaceName name = scene_->face_name(n);
      if (name.instance == instance && name.face == face) return n;
    }
    ADD_FAILURE() << "no such face";
    return 0;
  }
};

std::size_t pixels_of(const Frame& frame, std::uint32_t number) {
  return static_cast<std::size_t>(std::count(frame.face.begin(), frame.face.end(), number));
}

TEST_F(Looks, AHiddenPlacementIsNotThere) {
  scene_->set_visible(0, false);
  const Frame hidden = draw();
  HandMade without = made_;
  without.model.instances.erase(without.model.instances.begin());
  const Frame expected = draw_other(without);
  // Depths are stored relative to the scene's nearest, which is another's.
  std::size_t different = 0;
  for (std::size_t i = 0; i < hidden.depth.size(); ++i) {
    different += std::isinf(hidden.depth[i]) ? !std::isinf(expected.depth[i])
                                             : !(std::abs(hidden.depth[i] - expected.depth[i]) < 1e-3);
    for (std::size_t k = 4 * i; k < 4 * i + 4; ++k)
      different += std::abs(hidden.screen[k] - expected.screen[k]) > 2;
  }
  EXPECT_LE(different, 2U);
}

TEST_F(Looks, AHiddenFaceIsNotThereAndHidesNothing) {
  const Frame all = draw();
  std::size_t seen = 0;
  for (std::uint32_t instance = 0; instance < 2; ++instance)
    for (std::uint32_t face = 0; face < made_.model.parts[instance].faces.size(); ++face) {
      const std::uint32_t number = number_of(instance, face);
      scene_->set_visible(instance, false, face);
      const Frame frame = draw();
      seen += pixels_of(all, number);
      EXPECT_EQ(pixels_of(frame, number), 0U);
      for (std::size_t i = 0; i < all.face.size(); ++i)
        if (all.face[i] != number) {
          EXPECT_EQ(frame.face[i], all.face[i]);
        }
      scene_->set_visible(instance, true, face);
    }
  EXPECT_GT(seen, 1200U);
  EXPECT_EQ(draw().screen, all.screen);
}

TEST_F(Looks, OneFaceOfAHiddenPlacementMayBeShown) {
  scene_->set_visible(0, false);
  scene_->set_visible(0, true, 2);
  const Frame frame = draw();
  EXPECT_GT(pixels_of(frame, number_of(0, 2)), 50U);
  EXPECT_EQ(pixels_of(frame, number_of(0, 0)), 0U);
}

TEST_F(Looks, TrianglesOfAHiddenFaceAreNotDrawn) {
  made_.model.parts[1].faces.resize(2);
  made_.model.parts[1].mesh.faces = {0, 0, 1, 1};
  DrawOptions options = numbers_and_colors();
  made_.dps.parts[1] = {};
  const auto scene = gl_.renderer->upload(made_.model, nullptr);
  ASSERT_TRUE(scene.ok()) << scene.status().message;
  const auto count = [&] {
    const Frame frame = gl_.draw(**scene, camera_, options);
    return std::pair(pixels_of(frame, 1), pixels_of(frame, 2));
  };
  const auto all = count();
  EXPECT_GT(all.first, 100U);
  EXPECT_GT(all.second, 100U);
  const std::uint32_t instance = (*scene)->face_name(1).instance;
  (*scene)->set_visible(instance, false, 0);
  EXPECT_EQ(count().first, 0U);
  EXPECT_GE(count().second, all.second);
}

TEST_F(Looks, AColorOfTheWholeIsThatOfEveryFace) {
  const Color color{0.7F, 0.2F, 0.1F, 1};
  for (std::uint32_t i = 0; i < 3; ++i) scene_->set_color(i, color);
  const Frame changed = draw();
  scene_->reset_looks();
  DrawOptions all = numbers_and_colors();
  all.color = color;
  EXPECT_EQ(changed.screen, draw(all).screen);
  EXPECT_NE(changed.screen, draw().screen);
}

TEST_F(Looks, AHighlightIsSeenInEveryKindOfShadingAndNowhereElse) {
  const std::uint32_t face = 1, number = number_of(0, face);
  for (const Shading shading : {Shading::lit, Shading::mean, Shading::zebra}) {
    DrawOptions options = numbers_and_colors(shading);
    options.color = Color{0.2F, 0.2F, 0.2F, 1};
    options.outputs = kFace;
    const Frame numbers = draw(options);
    options.outputs = kScreen;
    const Frame before = draw(options);
    scene_->set_highlight(0, Color{0.9F, 0.6F, 0, 1}, face);
    const Frame after = draw(options);
    scene_->set_highlight(0, std::nullopt, face);
    std::size_t changed = 0, elsewhere = 0;
    for (std::size_t i = 0; i < numbers.face.size(); ++i) {
      bool differs = false;
      for (std::size_t k = 4 * i; k < 4 * i + 4; ++k)
        differs |= std::abs(before.screen[k] - after.screen[k]) > 1;
      (numbers.face[i] == number ? changed : elsewhere) += differs;
    }
    const std::string name(kShadingNames[static_cast<std::size_t>(shading)]);
    EXPECT_GT(pixels_of(numbers, number), 100U);
    EXPECT_GT(changed, pixels_of(numbers, number) * 9 / 10) << name;
    EXPECT_EQ(elsewhere, 0U) << name;
  }
}

TEST_F(Looks, AMovedPlacementIsWhereAnUploadedOneWouldBe) {
  const Affine3 moved = rigid({1, 2, 0}, 1.1, {2, 3, -1});
  scene_->place(1, moved);
  HandMade expected = made_;
  expected.model.instances[1].to_world = moved;
  const auto other = gl_.upload(expected);
  EXPECT_EQ(scene_->box().lo.x, other->box().lo.x);
  EXPECT_EQ(scene_->box().hi.z, other->box().hi.z);
  EXPECT_EQ(draw().screen, gl_.draw(*other, camera_, numbers_and_colors()).screen);
}

}  // namespace
}  // namespace dupin::testing
