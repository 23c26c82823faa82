#include "storage/trips/source/trip_contents.hpp"

#include "estimator/common/error.hpp"

#include <algorithm>
#include <utility>

namespace macadam {

namespace {

class KeptBytes final : public ByteStream {
public:
    KeptBytes(std::shared_ptr<const TripContents> contents, const std::string& bytes)
        : contents_{std::move(contents)}, bytes_{bytes} {}

    std::size_t read(std::span<char> into) override {
        const auto count = bytes_.copy(into.data(), into.size(), at_);
        at_ += count;
        return count;
    }

    std::uint64_t consumed() const override { return at_; }

private:
    std::shared_ptr<const TripContents> contents_;
    const std::string& bytes_; ///< of one of the files
    std::size_t at_ = 0;
};

} // namespace

std::unique_ptr<ByteStream> bytes_of(const std::shared_ptr<const TripContents>& contents,
                                     std::string_view name) {
    const auto file = std::find_if(contents->files.begin(),
                                   contents->files.end(),
                                   [&](const TripContents::File& f) { return f.name == name; });
    if (file == contents->files.end()) {
        return nullptr;
    }
    if (!file->refusal.empty()) {
        throw InputError{file->refusal};
    }
    return std::make_unique<KeptBytes>(contents, file->bytes);
}

} // namespace macadam
