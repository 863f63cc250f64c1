// OpenCV in its usual form: a background subtractor, inRange on hue, a median; histograms tile by tile; block
// matching.
#include <array>

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/background_segm.hpp>

#include "benchmarks/peers/peers.h"

namespace enc::bench {
namespace {

cv::Mat seen(const ImageView& image) {
  return {image.height, image.width, CV_8UC3, const_cast<std::uint8_t*>(image.rgb)};  // it is only read
}
cv::Mat seen(const Mask& mask) {
  return {mask.height, mask.width, CV_8UC1, const_cast<std::uint8_t*>(mask.on.data())};
}

class BackgroundPeer final : public SegmentationPeer {
 public:
  BackgroundPeer(cv::Ptr<cv::BackgroundSubtractor> background, const HueRange& skin)
      : background_(std::move(background)), skin_(skin) {
    cv::setNumThreads(1);
  }
  void learn(const ImageView& frame) override { background_->apply(seen(frame), fresh_); }
  void segment(const ImageView& frame, Mask& skin) override {
    background_->apply(seen(frame), fresh_, 0.0);
    cv::threshold(fresh_, fresh_, 200.0, 255.0, cv::THRESH_BINARY);  // shadows are 127
    cv::cvtColor(seen(frame), hsv_, cv::COLOR_RGB2HSV_FULL);
    const auto in = [&](int from, int to, cv::Mat& out) {
      cv::inRange(hsv_, cv::Scalar(from, skin_.least_saturation, skin_.least_value), cv::Scalar(to, 255, 255),
                  out);
    };
    if (skin_.from <= skin_.to) {
      in(skin_.from, skin_.to, hue_);
    } else {
      in(skin_.from, 255, hue_);
      in(0, skin_.to, past_);
      cv::bitwise_or(hue_, past_, hue_);
    }
    cv::bitwise_and(fresh_, hue_, fresh_);
    cv::Mat out = seen(skin);
    cv::medianBlur(fresh_, out, 5);
  }

 private:
  cv::Ptr<cv::BackgroundSubtractor> background_;
  HueRange skin_;
  cv::Mat fresh_, hsv_, hue_, past_;
};

class Histograms final : public TilePeer {
 public:
  Histograms(int side, int bins) : side_(side), bins_(bins) { cv::setNumThreads(1); }
  void learn(const ImageView& frame) override {
    model_.clear();
    each_tile(frame, [&](const cv::Mat& histogram) { model_.push_back(histogram.clone()); });
  }
  void match(const ImageView& frame, double match, std::vector<std::uint8_t>& found) override {
    found.resize(model_.size());
    std::size_t tile = 0;
    each_tile(frame, [&](const cv::Mat& histogram) {
      const double common = cv::compareHist(histogram, model_[tile], cv::HISTCMP_INTERSECT);
      found[tile++] = common < match * side_ * side_ ? 255 : 0;
    });
  }

 private:
  template <class Use>
  void each_tile(const ImageView& frame, const Use& use) {
    cv::cvtColor(seen(frame), hsv_, cv::COLOR_RGB2HSV_FULL);
    cv::extractChannel(hsv_, hue_, 0);
    const std::array<float, 2> range{0.0F, 256.0F};
    const float* ranges = range.data();
    const int channel = 0;
    for (int y = 0; y + side_ <= hue_.rows; y += side_)
      for (int x = 0; x + side_ <= hue_.cols; x += side_) {
        const cv::Mat tile = hue_(cv::Rect(x, y, side_, side_));
        cv::calcHist(&tile, 1, &channel, cv::noArray(), histogram_, 1, &bins_, &ranges);
        use(histogram_);
      }
  }
  int side_, bins_;
  std::vector<cv::Mat> model_;
  cv::Mat hsv_, hue_, histogram_;
};

class Blocks final : public StereoPeer {
 public:
  Blocks(int disparities, int block) : matcher_(cv::StereoBM::create(disparities, block)) {
    cv::setNumThreads(1);
  }
  void disparity(const ImageView& left, const ImageView& right) override {
    cv::cvtColor(seen(left), left_, cv::COLOR_RGB2GRAY);
    cv::cvtColor(seen(right), right_, cv::COLOR_RGB2GRAY);
    matcher_->compute(left_, right_, disparity_);
  }

 private:
  cv::Ptr<cv::StereoBM> matcher_;
  cv::Mat left_, right_, disparity_;
};

std::unique_ptr<SegmentationPeer> mog2(const HueRange& skin) {
  return std::make_unique<BackgroundPeer>(cv::createBackgroundSubtractorMOG2(), skin);
}
std::unique_ptr<SegmentationPeer> knn(const HueRange& skin) {
  return std::make_unique<BackgroundPeer>(cv::createBackgroundSubtractorKNN(), skin);
}
std::unique_ptr<TilePeer> tiles(int side, int bins) { return std::make_unique<Histograms>(side, bins); }
std::unique_ptr<StereoPeer> stereo(int disparities, int block) {
  return std::make_unique<Blocks>(disparities, block);
}
void median(const Mask& in, int side, Mask& out) {
  cv::setNumThreads(1);
  cv::Mat to = seen(out);
  cv::medianBlur(seen(in), to, side);
}

}  // namespace

const OpenCv kOpenCv{mog2, knn, tiles, median, stereo};

}  // namespace enc::bench
