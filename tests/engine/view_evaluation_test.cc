#include "engine/evaluation/view_evaluation.h"

#include "engine/evaluation/immersive_psnr.h"

#include "tests/engine/engine_test.h"

namespace vantage::view_evaluation_test {

Photograph picture(int width, int height, int channels,
                   const std::function<int(int, int, int)>& level) {
  Image<std::uint8_t> image(width, height, channels);
  for (const auto [x, y] : positions_of(width, height)) {
    for (int c = 0; c < channels; ++c) {
      image.at(x, y, c) = static_cast<std::uint8_t>(level(x, y, c));
    }
  }
  return {std::move(image)};
}

Photograph random_picture(int width, int height, int channels, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> noise(0, 40);
  return picture(width, height, channels, [&](int x, int y, int c) {
    return 20 + (x * 7 + y * 3 + c * 11) % 180 + noise(random);
  });
}

double luma(const Photograph& photograph, int x, int y) {
  const auto& image = std::get<Image<std::uint8_t>>(photograph.pixels);
  if (image.channels() < 3) {
    return image.at(x, y);
  }
  return 0.299 * image.at(x, y, 0) + 0.587 * image.at(x, y, 1) + 0.114 * image.at(x, y, 2);
}

// Window by window, with two-dimensional weights and central moments.
double plain_ssim(const Photograph& a, const Photograph& b) {
  double weights[11][11];
  double weight_sum = 0;
  for (const auto [i, j] : positions_of(11, 11)) {
    weights[j][i] = std::exp(-((i - 5) * (i - 5) + (j - 5) * (j - 5)) / 4.5);
    weight_sum += weights[j][i];
  }
  double sum = 0;
  int windows = 0;
  for (int y = 0; y + 11 <= a.height(); ++y) {
    for (int x = 0; x + 11 <= a.width(); ++x, ++windows) {
      const auto average = [&](const std::function<double(int, int)>& value) {
        double total = 0;
        for (const auto [i, j] : positions_of(11, 11)) {
          total += weights[j][i] * value(x + i, y + j);
        }
        return total / weight_sum;
      };
      const double mean_a = average([&](int u, int v) { return luma(a, u, v); });
      const double mean_b = average([&](int u, int v) { return luma(b, u, v); });
      const double variance_a =
          average([&](int u, int v) { return std::pow(luma(a, u, v) - mean_a, 2); });
      const double variance_b =
          average([&](int u, int v) { return std::pow(luma(b, u, v) - mean_b, 2); });
      const double covariance = average(
          [&](int u, int v) { return (luma(a, u, v) - mean_a) * (luma(b, u, v) - mean_b); });
      const double c1 = 2.55 * 2.55;
      const double c2 = 7.65 * 7.65;
      sum += (2 * mean_a * mean_b + c1) * (2 * covariance + c2) /
             ((mean_a * mean_a + mean_b * mean_b + c1) * (variance_a + variance_b + c2));
    }
  }
  return sum / windows;
}

TEST(ViewEvaluation, SsimAgreesWithPlainTranscription) {
  for (const auto& [width, height] : {std::pair{11, 11}, {12, 11}, {11, 29}, {37, 23}}) {
    for (const int channels : {1, 3, 4}) {
      const Photograph a = random_picture(width, height, channels, 1);
      const Photograph b = random_picture(width, height, channels, 2);
      const ViewScores scores = evaluate_view(a, b, execution());
      ASSERT_TRUE(scores.ssim.has_value());
      EXPECT_NEAR(*scores.ssim, plain_ssim(a, b), 1e-9);
      EXPECT_LT(*scores.ssim, 0.99);
    }
  }
}

TEST(ViewEvaluation, SsimIsOneForEqualAndNegativeForInvertedPictures) {
  const Photograph a = random_picture(20, 20, 1, 3);
  const Photograph inverted =
      picture(20, 20, 1, [&](int x, int y, int) { return 255 - static_cast<int>(luma(a, x, y)); });
  EXPECT_NEAR(evaluate_view(a, a, execution()).ssim.value(), 1, 1e-12);
  EXPECT_LT(evaluate_view(a, inverted, execution()).ssim.value(), 0);
  EXPECT_EQ(evaluate_view(a, a, execution()).psnr_db, std::numeric_limits<double>::infinity());
}

TEST(ViewEvaluation, PsnrOfAConstantDifference) {
  const Photograph a = picture(5, 3, 3, [](int, int, int) { return 100; });
  const Photograph b = picture(5, 3, 3, [](int, int, int c) { return c == 1 ? 110 : 100; });
  const ViewScores scores = evaluate_view(a, b, execution());
  EXPECT_NEAR(scores.psnr_db, 10 * std::log10(255.0 * 255.0 * 3 / 100), 1e-9);
  EXPECT_NEAR(scores.mean_absolute_difference, 10.0 / 3, 1e-12);
  EXPECT_EQ(scores.pixels, 15);
  EXPECT_FALSE(scores.ssim.has_value());
}

TEST(ViewEvaluation, MaskSelectsPixels) {
  const Photograph a = picture(3, 2, 1, [](int, int, int) { return 50; });
  const Photograph b = picture(3, 2, 1, [](int x, int y, int) { return 50 + 10 * x + y; });
  Mask mask(3, 2);
  mask.fill(0);
  mask.at(2, 0) = 255;
  mask.at(1, 1) = 254;  // not set
  const ViewScores scores = evaluate_view(a, b, execution(), mask.view());
  EXPECT_EQ(scores.pixels, 1);
  EXPECT_DOUBLE_EQ(scores.mean_absolute_difference, 20);
  mask.fill(0);
  EXPECT_THROW((void)evaluate_view(a, b, execution(), mask.view()), Error);
}

TEST(ViewEvaluation, DepthsShareOneScaleAndAlphaIsLeftOut) {
  const Photograph a = random_picture(13, 12, 4, 5);
  const auto& bytes = std::get<Image<std::uint8_t>>(a.pixels);
  Image<std::uint16_t> deep(13, 12, 3);
  Image<float> real(13, 12, 4);
  for (const auto [x, y] : positions_of(13, 12)) {
    for (int c = 0; c < 4; ++c) {
      real.at(x, y, c) = c == 3 ? 0.5F : static_cast<float>(bytes.at(x, y, c)) / 255;
      if (c < 3) {
        deep.at(x, y, c) = static_cast<std::uint16_t>(bytes.at(x, y, c) * 257);
      }
    }
  }
  const Photograph deep_picture{std::move(deep)};
  const Photograph real_picture{std::move(real)};
  EXPECT_LT(evaluate_view(a, deep_picture, execution()).mean_absolute_difference, 1e-4);
  EXPECT_LT(evaluate_view(deep_picture, real_picture, execution()).mean_absolute_difference, 1e-4);
}

TEST(ViewEvaluation, GreyIsComparedWithLuma) {
  const Photograph colour = picture(4, 4, 3, [](int, int, int c) { return c == 0 ? 200 : 0; });
  const Photograph grey = picture(4, 4, 1, [](int, int, int) { return 0; });
  EXPECT_NEAR(evaluate_view(colour, grey, execution()).mean_absolute_difference, 0.299 * 200, 1e-9);
}

TEST(ViewEvaluation, SameForAnyExecution) {
  const Photograph a = random_picture(61, 53, 3, 8);
  const Photograph b = random_picture(61, 53, 3, 9);
  const ViewScores expected = evaluate_view(a, b, execution());
  for (const int threads : {1, 2, 5}) {
    Execution execution({.threads = threads});
    const ViewScores scores = evaluate_view(a, b, execution);
    EXPECT_EQ(scores.ssim, expected.ssim);
    EXPECT_EQ(scores.psnr_db, expected.psnr_db);
  }
}

TEST(ViewEvaluation, SizesMustAgree) {
  const Photograph a = random_picture(4, 3, 1, 1);
  const Photograph b = random_picture(3, 4, 1, 1);
  const Mask mask(3, 4);
  EXPECT_THROW((void)evaluate_view(a, b, execution()), Error);
  EXPECT_THROW((void)evaluate_view(a, a, execution(), mask.view()), Error);
}

// Pixel by pixel, in double.
double plain_iv_psnr(const Photograph& view, const Photograph& truth, const Mask* mask) {
  const bool is_grey = view.channels() < 3 || truth.channels() < 3;
  const auto component = [&](const Photograph& picture, int x, int y, int c) {
    const double y_level = luma(picture, x, y);
    const auto& image = std::get<Image<std::uint8_t>>(picture.pixels);
    return c == 0   ? y_level
           : c == 1 ? (image.at(x, y, 2) - y_level) / 1.772
                    : (image.at(x, y, 0) - y_level) / 1.402;
  };
  const std::vector<double> weights =
      is_grey ? std::vector<double>{4} : std::vector<double>{4, 1, 1};
  const auto counts = [&](int x, int y) { return mask == nullptr || mask->at(x, y) == 255; };
  const int width = view.width();
  const int height = view.height();
  const auto one_way = [&](const Photograph& from, const Photograph& to) {
    std::vector<double> offset(weights.size());
    double pixels = 0;
    for (const auto [x, y] : positions_of(width, height)) {
      pixels += counts(x, y) ? 1 : 0;
      for (std::size_t c = 0; c < weights.size() && counts(x, y); ++c) {
        offset[c] += component(to, x, y, int(c)) - component(from, x, y, int(c));
      }
    }
    std::vector<double> squared(weights.size());
    for (const auto [x, y] : positions_of(width, height)) {
      double least = std::numeric_limits<double>::infinity();
      std::vector<double> of_least(weights.size());
      for (int v = std::max(0, y - 2); v <= std::min(height - 1, y + 2); ++v) {
        for (int u = std::max(0, x - 2); u <= std::min(width - 1, x + 2); ++u) {
          std::vector<double> now(weights.size());
          double cost = 0;
          for (std::size_t c = 0; c < weights.size(); ++c) {
            now[c] = std::pow(component(from, x, y, int(c)) +
                                  std::clamp(offset[c] / pixels, -2.55, 2.55) -
                                  component(to, u, v, int(c)),
                              2);
            cost += weights[c] * now[c];
          }
          if (cost < least) {
            least = cost;
            of_least = now;
          }
        }
      }
      for (std::size_t c = 0; c < weights.size() && counts(x, y); ++c) {
        squared[c] += of_least[c];
      }
    }
    if (std::ranges::count(squared, 0.0) == std::ssize(squared)) {
      return std::numeric_limits<double>::infinity();
    }
    double sum = 0;
    double sum_of_weights = 0;
    for (std::size_t c = 0; c < weights.size(); ++c) {
      sum += weights[c] * std::min(100.0, 10 * std::log10(255 * 255 * pixels / squared[c]));
      sum_of_weights += weights[c];
    }
    return sum / sum_of_weights;
  };
  return std::min(one_way(view, truth), one_way(truth, view));
}

TEST(ImmersivePsnr, AgreesWithPlainTranscription) {
  for (const auto& [width, height] : {std::pair{1, 1}, {2, 9}, {37, 23}}) {
    Mask mask(width, height);
    for (const auto [x, y] : positions_of(width, height)) {
      mask.at(x, y) = (x + 2 * y) % 3 == 0 ? 255 : 254;
    }
    for (const int channels : {1, 3, 4}) {
      const Photograph a = random_picture(width, height, channels, 1);
      for (const int channels_of_truth : {1, 3}) {
        const Photograph b = random_picture(width, height, channels_of_truth, 2);
        const double whole = plain_iv_psnr(a, b, nullptr);
        if (std::isinf(whole)) {
          EXPECT_EQ(immersive_psnr_db(a, b), whole);
          continue;
        }
        EXPECT_NEAR(immersive_psnr_db(a, b), whole, 1e-3);
        EXPECT_NEAR(immersive_psnr_db(a, b, mask.view()), plain_iv_psnr(a, b, &mask), 1e-3);
      }
    }
  }
}

TEST(ImmersivePsnr, ForgivesShiftsAndSlightOffsets) {
  const auto pattern = [](int dx, int dy, int more) {
    return picture(40, 30, 3, [=](int x, int y, int c) {
      return ((x + dx) * 37 + (y + dy) * 91 + c * 50) % 120 + 60 + more;
    });
  };
  const Photograph truth = pattern(0, 0, 0);
  EXPECT_EQ(immersive_psnr_db(truth, truth), std::numeric_limits<double>::infinity());
  EXPECT_GT(immersive_psnr_db(pattern(2, -2, 2), truth), 25);
  EXPECT_LT(evaluate_view(pattern(2, -2, 2), truth, execution()).psnr_db, 20);
  const auto flat = [](int level) {
    return picture(9, 8, 1, [=](int, int, int) { return level; });
  };
  EXPECT_NEAR(immersive_psnr_db(flat(80), flat(100)), 20 * std::log10(255 / (20 - 2.55)), 1e-4);
}

TEST(ViewFlicker, CountsChangesOfTheError) {
  ViewFlicker flicker;
  Mask left_half(10, 6);
  for (const auto [x, y] : positions_of(10, 6)) {
    left_half.at(x, y) = x < 5 ? 255 : 0;
  }
  const auto view = [](int frame, int error) {
    return picture(10, 6, 3, [=](int x, int y, int c) {
      return 3 * frame + x + y + c + (x < 5 && c == 1 ? error : 7);
    });
  };
  const auto truth = [](int frame) {
    return picture(10, 6, 3, [=](int x, int y, int c) { return 3 * frame + x + y + c; });
  };
  flicker.add(view(0, 4), truth(0), left_half.view());
  EXPECT_FALSE(flicker.mean_levels().has_value());
  flicker.add(view(1, 4), truth(1), left_half.view());
  EXPECT_EQ(flicker.mean_levels(), 0);  // the error stays
  flicker.add(view(2, 16), truth(2), left_half.view());
  EXPECT_NEAR(flicker.masked_mean_levels().value(), 12.0 / 3 / 2, 1e-12);
  EXPECT_NEAR(flicker.mean_levels().value(), 12.0 / 3 / 2 / 2, 1e-12);
  EXPECT_THROW(flicker.add(view(3, 0), random_picture(10, 5, 3, 1)), Error);
}

}  // namespace vantage::view_evaluation_test
