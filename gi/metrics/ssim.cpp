#include "gi/metrics/ssim.h"

#include <algorithm>
#include <cmath>

namespace gi {
namespace {

constexpr int kWindowRadius = 5;
constexpr double kSigma = 1.5, kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;

std::vector<double> window(int size)
{
    std::vector<double> w;
    double sum = 0;
    for (int i = 0; i < size; ++i) {
        double const x = i - 0.5 * (size - 1);
        w.push_back(std::exp(-x * x / (2 * kSigma * kSigma)));
        sum += w.back();
    }
    for (double& v : w) v /= sum;
    return w;
}

/// Weighted means over all windows that lie inside the picture.
std::vector<double> local_means(std::vector<double> const& in, int width, int height,
                                std::vector<double> const& wx, std::vector<double> const& wy)
{
    int const w = width - int(wx.size()) + 1, h = height - int(wy.size()) + 1;
    std::vector<double> rows(std::size_t(w) * std::size_t(height)), out(std::size_t(w) * std::size_t(h));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < w; ++x) {
            double sum = 0;
            for (std::size_t k = 0; k < wx.size(); ++k)
                sum += wx[k] * in[std::size_t(y) * std::size_t(width) + std::size_t(x) + k];
            rows[std::size_t(y) * std::size_t(w) + std::size_t(x)] = sum;
        }
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            double sum = 0;
            for (std::size_t k = 0; k < wy.size(); ++k)
                sum += wy[k] * rows[(std::size_t(y) + k) * std::size_t(w) + std::size_t(x)];
            out[std::size_t(y) * std::size_t(w) + std::size_t(x)] = sum;
        }
    return out;
}

} // namespace

double ssim(std::vector<float> const& image, std::vector<float> const& reference, int width, int height)
{
    std::vector<double> const wx = window(std::min(width, 2 * kWindowRadius + 1)),
                              wy = window(std::min(height, 2 * kWindowRadius + 1));
    std::size_t const n = image.size();
    std::vector<double> a(n), b(n), aa(n), bb(n), ab(n);
    for (std::size_t i = 0; i < n; ++i) {
        a[i] = double(image[i]);
        b[i] = double(reference[i]);
        aa[i] = a[i] * a[i];
        bb[i] = b[i] * b[i];
        ab[i] = a[i] * b[i];
    }
    auto const means = [&](std::vector<double> const& v) { return local_means(v, width, height, wx, wy); };
    auto const ma = means(a), mb = means(b), maa = means(aa), mbb = means(bb), mab = means(ab);
    double sum = 0;
    for (std::size_t i = 0; i < ma.size(); ++i) {
        double const va = maa[i] - ma[i] * ma[i], vb = mbb[i] - mb[i] * mb[i], cov = mab[i] - ma[i] * mb[i];
        sum += (2 * ma[i] * mb[i] + kC1) * (2 * cov + kC2) /
               ((ma[i] * ma[i] + mb[i] * mb[i] + kC1) * (va + vb + kC2));
    }
    return sum / double(ma.size());
}

} // namespace gi
