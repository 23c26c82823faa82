#include "storage/objects/http_transfer.hpp"

#include <curl/curl.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <new>

namespace macadam {
namespace {

constexpr std::size_t max_words = 1024;

struct Cleanup {
    void operator()(CURL* handle) const { curl_easy_cleanup(handle); }
};
struct FreeList {
    void operator()(curl_slist* list) const { curl_slist_free_all(list); }
};
using HeaderList = std::unique_ptr<curl_slist, FreeList>;

/// What the callbacks of one transfer share. No exception passes through libcurl, which is C.
struct Running {
    CURL* handle;
    const HttpTransfer& transfer;
    HttpOutcome& outcome;
    std::exception_ptr thrown{};
};

std::size_t send(char* to, std::size_t size, std::size_t count, void* user) {
    auto& running = *static_cast<Running*>(user);
    try {
        return running.transfer.body({to, size * count});
    } catch (...) {
        running.thrown = std::current_exception();
        return CURL_READFUNC_ABORT;
    }
}

std::size_t receive(const char* from, std::size_t size, std::size_t count, void* user) {
    auto& running = *static_cast<Running*>(user);
    const std::string_view bytes{from, size * count};
    constexpr std::size_t aborted = 0; // unlike the number of bytes
    long status = 0;
    curl_easy_getinfo(running.handle, CURLINFO_RESPONSE_CODE, &status);
    try {
        if (status / 100 != 2) {
            auto& words = running.outcome.words;
            words += bytes.substr(0, max_words - std::min(words.size(), max_words));
            return bytes.size();
        }
        return !running.transfer.receive || running.transfer.receive(bytes) ? bytes.size()
                                                                            : aborted;
    } catch (...) {
        running.thrown = std::current_exception();
        return aborted;
    }
}

int is_stopped(void* user, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
    return static_cast<Running*>(user)->transfer.stop.stop_requested() ? 1 : 0;
}

HeaderList header_list(const std::vector<std::string>& headers) {
    HeaderList list;
    for (const auto& header : headers) {
        auto* const longer = curl_slist_append(list.get(), header.c_str());
        if (longer == nullptr) {
            throw std::bad_alloc{};
        }
        static_cast<void>(list.release());
        list.reset(longer);
    }
    return list;
}

/// Handle of this thread; it keeps connections to servers open.
CURL* reusable_handle() {
    static const CURLcode ready = curl_global_init(CURL_GLOBAL_DEFAULT);
    thread_local const std::unique_ptr<CURL, Cleanup> handle{ready == CURLE_OK ? curl_easy_init()
                                                                               : nullptr};
    if (!handle) {
        throw std::bad_alloc{};
    }
    curl_easy_reset(handle.get());
    return handle.get();
}

void set_limits(CURL* handle, const HttpTransfer& transfer) {
    constexpr long connect_s = 10, slow_s = 30, slow_bytes_per_s = 1024, least_s = 60;
    constexpr std::int64_t bytes_per_s = 64 << 10;
    curl_easy_setopt(handle, CURLOPT_CONNECTTIMEOUT, connect_s);
    curl_easy_setopt(handle, CURLOPT_LOW_SPEED_LIMIT, slow_bytes_per_s);
    curl_easy_setopt(handle, CURLOPT_LOW_SPEED_TIME, slow_s);
    curl_easy_setopt(
        handle,
        CURLOPT_TIMEOUT,
        least_s + static_cast<long>((transfer.body_bytes + transfer.most_bytes) / bytes_per_s));
    curl_easy_setopt(handle, CURLOPT_NOSIGNAL, 1L);
    curl_easy_setopt(handle, CURLOPT_FOLLOWLOCATION, 0L);
    curl_easy_setopt(handle, CURLOPT_PROTOCOLS_STR, "http,https");
    curl_easy_setopt(handle, CURLOPT_SSL_VERIFYPEER, 1L);
    curl_easy_setopt(handle, CURLOPT_SSL_VERIFYHOST, 2L);
    curl_easy_setopt(handle, CURLOPT_SSLVERSION, static_cast<long>(CURL_SSLVERSION_TLSv1_2));
}

void run(const HttpTransfer& transfer, HttpOutcome& outcome) {
    auto* const handle = reusable_handle();
    Running running{handle, transfer, outcome};
    const auto headers = header_list(transfer.headers);
    set_limits(handle, transfer);
    curl_easy_setopt(handle, CURLOPT_URL, transfer.url.c_str());
    if (transfer.url.starts_with("http://")) { // to this machine: logs must not leave it in clear
        curl_easy_setopt(handle, CURLOPT_PROXY, "");
    }
    curl_easy_setopt(handle, CURLOPT_PATH_AS_IS, 1L); // as it was signed
    curl_easy_setopt(handle, CURLOPT_HTTPHEADER, headers.get());
    curl_easy_setopt(handle, CURLOPT_WRITEFUNCTION, receive);
    curl_easy_setopt(handle, CURLOPT_WRITEDATA, &running);
    curl_easy_setopt(handle, CURLOPT_NOPROGRESS, 0L);
    curl_easy_setopt(handle, CURLOPT_XFERINFOFUNCTION, is_stopped);
    curl_easy_setopt(handle, CURLOPT_XFERINFODATA, &running);
    if (transfer.body) {
        curl_easy_setopt(handle, CURLOPT_UPLOAD, 1L);
        curl_easy_setopt(handle, CURLOPT_READFUNCTION, send);
        curl_easy_setopt(handle, CURLOPT_READDATA, &running);
        curl_easy_setopt(
            handle, CURLOPT_INFILESIZE_LARGE, static_cast<curl_off_t>(transfer.body_bytes));
    }
    curl_easy_setopt(handle, CURLOPT_CUSTOMREQUEST, transfer.method.c_str());
    const auto code = curl_easy_perform(handle);
    if (running.thrown) {
        std::rethrow_exception(running.thrown);
    }
    curl_easy_getinfo(handle, CURLINFO_RESPONSE_CODE, &outcome.status);
    if (code != CURLE_OK) {
        outcome.failure = curl_easy_strerror(code);
        outcome.is_final = code == CURLE_PEER_FAILED_VERIFICATION || code == CURLE_URL_MALFORMAT ||
                           code == CURLE_WRITE_ERROR || code == CURLE_ABORTED_BY_CALLBACK;
    }
}

} // namespace
} // namespace macadam

extern "C" void macadam_http_run(const macadam::HttpTransfer& transfer,
                                 macadam::HttpOutcome& outcome) {
    macadam::run(transfer, outcome);
}
