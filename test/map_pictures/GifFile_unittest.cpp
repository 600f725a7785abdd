#include <gif_lib.h>
#include <gtest/gtest.h>
#include <map_pictures/PictureFiles.h>
#include <rapidcheck/gtest.h>

#include <memory>

#include "FullDisk.h"
#include "TemporaryFolder.h"

using map_pictures::GifFile;

namespace {

using GifFiles = FolderTest;

/** What a viewer shows, frame by frame, as giflib reads it back. */
class Played {
 public:
  explicit Played(const std::filesystem::path& file) {
    int error = 0;
    const std::unique_ptr<GifFileType, void (*)(GifFileType*)> gif(
        DGifOpenFileName(file.c_str(), &error), [](GifFileType* g) { DGifCloseFile(g, nullptr); });
    if (!gif || DGifSlurp(gif.get()) == GIF_ERROR) throw std::runtime_error("no GIF");
    m_screen = cv::Mat(gif->SHeight, gif->SWidth, CV_8UC3, cv::Scalar(1, 2, 3));
    for (int i = 0; i < gif->ImageCount; ++i) {
      GraphicsControlBlock control;
      if (DGifSavedExtensionToGCB(gif.get(), i, &control) == GIF_ERROR)
        throw std::runtime_error("a frame without its control block");
      delays.push_back(control.DelayTime);
      show(gif->SavedImages[i], control.TransparentColor);
    }
  }

  std::vector<cv::Mat> frames;
  std::vector<int> delays;       ///< 0.01 s
  std::vector<cv::Rect> places;  ///< of what each frame draws

 private:
  void show(const SavedImage& image, int transparent) {
    const GifImageDesc& d = image.ImageDesc;
    places.emplace_back(d.Left, d.Top, d.Width, d.Height);
    for (int row = 0; row < d.Height; ++row)
      for (int col = 0; col < d.Width; ++col) {
        const int index = image.RasterBits[row * d.Width + col];
        if (index == transparent) continue;
        const GifColorType& c = d.ColorMap->Colors[index];
        m_screen.at<cv::Vec3b>(d.Top + row, d.Left + col) = {c.Blue, c.Green, c.Red};
      }
    frames.push_back(m_screen.clone());
  }

  cv::Mat m_screen;
};

double difference(const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF); }

/** Fields of a few colors, as maps have. */
cv::Mat fields() {
  cv::Mat picture(60, 100, CV_8UC3, cv::Scalar(250, 250, 250));
  picture(cv::Rect(10, 10, 40, 30)).setTo(cv::Scalar(30, 30, 200));
  picture(cv::Rect(40, 20, 50, 35)).setTo(cv::Scalar(60, 180, 30));
  return picture;
}

Played play(const std::vector<cv::Mat>& frames) {
  const TemporaryFolder folder;
  GifFile gif(folder / "a.gif", 0.12);
  for (const cv::Mat& frame : frames) gif.add(frame);
  gif.close();
  return Played(folder / "a.gif");
}

}  // namespace

TEST_F(GifFiles, framesOfFewColorsComeBackAsTheyWereAndDrawOnlyWhatChanged) {
  cv::Mat second = fields();
  const cv::Rect changed(70, 5, 8, 9);
  second(changed).setTo(cv::Scalar(0, 0, 0));
  const Played played = play({fields(), second, second, fields()});
  ASSERT_EQ(played.frames.size(), 4u);
  EXPECT_EQ(difference(played.frames[0], fields()), 0);
  for (const int i : {1, 2}) EXPECT_EQ(difference(played.frames[i], second), 0);
  EXPECT_EQ(difference(played.frames[3], fields()), 0);
  EXPECT_EQ(played.delays, (std::vector<int>{12, 12, 12, 12}));
  EXPECT_EQ(played.places[0], cv::Rect(0, 0, 100, 60));
  for (const int i : {1, 3}) EXPECT_EQ(played.places[i], changed);
  EXPECT_EQ(played.places[2].area(), 1);
}

TEST_F(GifFiles, slowChangesAddUpUntilTheyAreDrawn) {
  std::vector<cv::Mat> frames;
  for (int gray = 100; gray < 200; gray += 3)
    frames.emplace_back(20, 20, CV_8UC3, cv::Scalar::all(gray));
  const Played played = play(frames);
  for (std::size_t i = 0; i < frames.size(); ++i)
    EXPECT_LE(difference(played.frames[i], frames[i]), 12) << i;
}

RC_GTEST_PROP(GifFile, whateverTheFramesAreTheLastIsShownNearly, ()) {
  const int width = *rc::gen::inRange(2, 40), height = *rc::gen::inRange(1, 40);
  std::vector<cv::Mat> frames;
  for (int i = *rc::gen::inRange(1, 4); i > 0; --i) {
    frames.emplace_back(height, width, CV_8UC3, cv::Scalar::all(*rc::gen::inRange(0, 256)));
    cv::RNG random(*rc::gen::inRange(1, 1000));
    random.fill(frames.back().colRange(0, width / 2), cv::RNG::UNIFORM, 0, 256);
  }
  const Played played = play(frames);
  RC_ASSERT(played.frames.size() == frames.size());
  RC_ASSERT(difference(played.frames.back().colRange(width / 2, width),
                       frames.back().colRange(width / 2, width)) <= 18);
}

TEST_F(GifFiles, withoutBeingClosedItIsNotThere) {
  { GifFile(folder / "a.gif", 0.1).add(fields()); }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST_F(GifFiles, whatCannotBeWrittenIsAnErrorThatNamesTheFile) {
  EXPECT_TRUE(contains(errorOf([&] { GifFile(folder / "no/a.gif", 0.1); }), "no/a.gif"));
  EXPECT_TRUE(contains(errorOf([&] { GifFile(folder / "b.gif", 0.1).close(); }), "b.gif"));
  const FullDisk disk(100);
  const std::string full = errorOf([&] {
    GifFile gif(folder / "full.gif", 0.1);
    gif.add(fields());
    gif.close();
  });
  EXPECT_TRUE(contains(full, "full.gif"));
  EXPECT_FALSE(std::filesystem::exists(folder / "full.gif"));
}

TEST_F(GifFiles, badFramesAndPeriodsAreNamed) {
  GifFile gif(folder / "a.gif", 0.1);
  gif.add(fields());
  EXPECT_TRUE(contains(errorOf([&] { gif.add(fields().rowRange(0, 9)); }), "size"));
  EXPECT_TRUE(contains(errorOf([&] { gif.add(cv::Mat(60, 100, CV_8U)); }), "3 channels"));
  EXPECT_TRUE(contains(errorOf([&] { GifFile(folder / "b.gif", 0); }), "secondsPerFrame is 0"));
}
