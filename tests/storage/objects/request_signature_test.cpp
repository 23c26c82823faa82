#include "storage/objects/request_signature.hpp"

#include <gtest/gtest.h>

namespace macadam {
namespace {

/// Signature of an authorization: its last 64 characters.
std::string signature_of(const S3Request& request,
                         const S3Credentials& credentials,
                         const SignatureScope& scope) {
    const auto text = authorization_of(request, credentials, scope);
    return text.substr(text.find("Signature=") + 10);
}

// Published by AWS: "Signature Calculations for the Authorization Header" (Amazon S3 API
// Reference), with the credentials of its examples.
const S3Credentials of_examples{.key_id = "AKIAIOSFODNN7EXAMPLE",
                                .secret = "wJalrXUtnFEMI/K7MDENG/bPxRfiCYEXAMPLEKEY"};
const SignatureScope day_of_examples{.region = "us-east-1", .time = "20130524T000000Z"};

S3Request example(const std::string& method, const std::string& path) {
    return {.method = method,
            .path = path,
            .headers = {{"host", "examplebucket.s3.amazonaws.com"},
                        {"x-amz-content-sha256", std::string{sha256_of_nothing}},
                        {"x-amz-date", "20130524T000000Z"}},
            .payload_sha256 = std::string{sha256_of_nothing}};
}

TEST(RequestSignature, IsThatOfTheExampleThatGetsAnObject) {
    auto request = example("GET", "/test.txt");
    request.headers.emplace_back("range", "bytes=0-9");
    EXPECT_EQ(canonical_request(request),
              "GET\n/test.txt\n\nhost:examplebucket.s3.amazonaws.com\nrange:bytes=0-9\n"
              "x-amz-content-sha256:"
              "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855\n"
              "x-amz-date:20130524T000000Z\n\nhost;range;x-amz-content-sha256;x-amz-date\n"
              "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(authorization_of(request, of_examples, day_of_examples),
              "AWS4-HMAC-SHA256 Credential=AKIAIOSFODNN7EXAMPLE/20130524/us-east-1/s3/aws4_request,"
              "SignedHeaders=host;range;x-amz-content-sha256;x-amz-date,"
              "Signature=f0e8bdb87c964420e857bd35b5d6ed310bd44f0170aba48dd91039c6036bdb41");
}

TEST(RequestSignature, IsThatOfTheExampleThatPutsAnObjectOfAnOddName) {
    auto request = example("PUT", "/test$file.text");
    request.payload_sha256 = "44ce7dd67c959e0d3524ffac1771dfbba87d2b6b4b4e99e42034a8b803f8b072";
    request.headers[1].second = request.payload_sha256;
    request.headers.emplace_back("date", "Fri, 24 May 2013 00:00:00 GMT");
    request.headers.emplace_back("x-amz-storage-class", "REDUCED_REDUNDANCY");
    EXPECT_EQ(signature_of(request, of_examples, day_of_examples),
              "98ad721746da40c64f1a55b78f14c238d841ea1380cd77a1b5971af0ece108bd");
}

TEST(RequestSignature, IsThatOfTheExamplesWithParameters) {
    auto lifecycle = example("GET", "/");
    lifecycle.query = {{"lifecycle", ""}};
    EXPECT_EQ(signature_of(lifecycle, of_examples, day_of_examples),
              "fea454ca298b7da1c68078a5d1bdbfbbe0d65c699e0f91ac7a200a0136783543");
    auto list = example("GET", "/");
    list.query = {{"prefix", "J"}, {"max-keys", "2"}};
    EXPECT_EQ(signature_of(list, of_examples, day_of_examples),
              "34b48302e7b5fa45bde8084f4b7868a86f0a534bc59db6670ed5711ef69dc6f7");
}

// AWS Signature Version 4 test suite: get-vanilla, post-vanilla, get-vanilla-query-order-key-case.
TEST(RequestSignature, IsThatOfTheTestSuite) {
    const S3Credentials keys{.key_id = "AKIDEXAMPLE",
                             .secret = "wJalrXUtnFEMI/K7MDENG+bPxRfiCYEXAMPLEKEY"};
    const SignatureScope scope{
        .region = "us-east-1", .service = "service", .time = "20150830T123600Z"};
    S3Request request{
        .method = "GET",
        .path = "/",
        .headers = {{"x-amz-date", "20150830T123600Z"}, {"host", "example.amazonaws.com"}},
        .payload_sha256 = std::string{sha256_of_nothing}};
    EXPECT_EQ(signature_of(request, keys, scope),
              "5fa00fa31553b73ebf1942676e86291e8372ff2a2260956d9b8aae1d763fbf31");
    request.query = {{"Param2", "value2"}, {"Param1", "value1"}};
    EXPECT_EQ(signature_of(request, keys, scope),
              "b97d918cfa904a5beff61c982a1b6f458b799221646efd99d3219ec94cdf2500");
    request.query.clear();
    request.method = "POST";
    EXPECT_EQ(signature_of(request, keys, scope),
              "5da7c1a2acd57cee7505fc6676e4e544621c30862966e37dddb68e92efbe5d6b");
}

} // namespace
} // namespace macadam
