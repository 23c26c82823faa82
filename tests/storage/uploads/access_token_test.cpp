#include "storage/uploads/access_token.hpp"

#include "storage/uploads/upload_database.hpp"
#include "support/files/files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <sstream>

namespace macadam::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;

constexpr std::int64_t now = 1'000'000;

Database new_uploads() {
    const auto store = test_folder() / "roads.gpkg";
    make_uploads_folder(store);
    return open_uploads(store);
}

AccessToken of(const std::string& owner, TokenScope scope = TokenScope::upload) {
    return {.id = {}, .owner = owner, .scope = scope, .created_ms = now, .expires_ms = now + 1000};
}

TEST(AccessToken, OpensUntilItExpiresOrIsRevoked) {
    auto uploads = new_uploads();
    const auto text = create_token(uploads, of("anna"));
    const auto found = find_token(uploads, text, now);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->owner, "anna");
    EXPECT_EQ(found->scope, TokenScope::upload);
    EXPECT_TRUE(find_token(uploads, text, now + 999));
    EXPECT_FALSE(find_token(uploads, text, now + 1000));
    EXPECT_EQ(revoke_tokens(uploads, "anna"), 1U);
    EXPECT_FALSE(find_token(uploads, text, now));
}

TEST(AccessToken, IsRefusedIfAnyLetterDiffers) {
    auto uploads = new_uploads();
    const auto text = create_token(uploads, of("anna"));
    ASSERT_EQ(text.size(), 77U); // mac_, 8 digits, _, 64 digits
    for (std::size_t i = 0; i < text.size(); ++i) {
        auto other = text;
        other[i] = other[i] == '0' ? '1' : '0';
        EXPECT_FALSE(find_token(uploads, other, now)) << i;
        EXPECT_FALSE(find_token(uploads, text.substr(0, i), now)) << i;
    }
    EXPECT_FALSE(find_token(uploads, text + "0", now));
    EXPECT_FALSE(find_token(uploads, "' OR 1=1 --", now));
}

TEST(AccessToken, IsNotKept) {
    std::string text;
    {
        auto uploads = new_uploads();
        text = create_token(uploads, of("anna"));
    }
    EXPECT_THAT(text, MatchesRegex("mac_[0-9a-f]+_[0-9a-f]+"));
    const auto folder = uploads_folder_of(std::filesystem::path{::testing::TempDir()} /
                                          "macadam_AccessToken_IsNotKept/roads.gpkg");
    std::size_t files = 0;
    for (const auto& file : std::filesystem::directory_iterator{folder}) {
        if (file.is_regular_file()) {
            std::ifstream in{file.path(), std::ios::binary};
            std::ostringstream bytes;
            bytes << in.rdbuf();
            EXPECT_EQ(bytes.str().find(text.substr(13)), std::string::npos) << file.path();
            ++files;
        }
    }
    EXPECT_GE(files, 1U);
    EXPECT_EQ(std::filesystem::status(folder).permissions(), std::filesystem::perms::owner_all);
}

TEST(AccessToken, OfOneNameHasOneScope) {
    auto uploads = new_uploads();
    create_token(uploads, of("anna"));
    create_token(uploads, of("anna"));
    EXPECT_THAT(refusal_of([&] { create_token(uploads, of("anna", TokenScope::operator_)); }),
                HasSubstr("'anna' has tokens for 'upload', expected a new name for 'operator'"));
    EXPECT_EQ(all_tokens(uploads).size(), 2U);
}

TEST(AccessToken, IsReadFromBearerAndFromBasic) {
    EXPECT_EQ(token_in("Bearer mac_1"), "mac_1");
    EXPECT_EQ(token_in("bearer mac_1"), "mac_1");
    EXPECT_EQ(token_in("Basic cWdpczptYWNfMQ=="), "mac_1"); // qgis:mac_1
    EXPECT_EQ(token_in("Basic OmE6Yg=="), "a:b");           // :a:b
    for (const auto* const none :
         {"", "Bearer", "mac_1", "Basic mac_1", "Basic cWdpcw==", "Basic ="}) {
        EXPECT_EQ(token_in(none), "") << none;
    }
}

constexpr std::int64_t again = 600'000; // ms in which an invitation can be taken again
constexpr std::int64_t far = 10 * again;

std::string invitation_of_ben(Database& uploads, std::int64_t expires_ms = now + far) {
    return create_invitation(
        uploads, {.owner = "ben", .expires_ms = expires_ms, .token_expires_ms = now + 2 * far});
}

TEST(Invitation, GivesATokenUntilItExpires) {
    auto uploads = new_uploads();
    const auto invitation = invitation_of_ben(uploads, now + 10);
    EXPECT_FALSE(find_token(uploads, invitation, now)); // it is no token itself
    EXPECT_FALSE(take_invitation(uploads, invitation, now + 10));
    const auto token = take_invitation(uploads, invitation, now + 9);
    ASSERT_TRUE(token);
    EXPECT_EQ(find_token(uploads, *token, now + 2 * far - 1)->owner, "ben");
    EXPECT_FALSE(find_token(uploads, *token, now + 2 * far));
    EXPECT_FALSE(take_invitation(uploads, invitation, now + 10)); // it lives no longer for that
}

TEST(Invitation, TakenAgainWithinMinutesReplacesATokenThatMayBeLost) {
    auto uploads = new_uploads();
    const auto invitation = invitation_of_ben(uploads);
    const auto lost = take_invitation(uploads, invitation, now);
    const auto token = take_invitation(uploads, invitation, now + again - 1);
    ASSERT_TRUE(lost && token);
    EXPECT_FALSE(find_token(uploads, *lost, now));
    EXPECT_TRUE(find_token(uploads, *token, now));
    EXPECT_EQ(all_tokens(uploads).size(), 1U);
    EXPECT_FALSE(take_invitation(uploads, invitation, now + again)); // minutes of the first time
    EXPECT_TRUE(find_token(uploads, *token, now));
}

TEST(Invitation, TakenLeavesOtherTokensOfItsName) {
    auto uploads = new_uploads();
    const auto other = create_token(uploads, of("ben"));
    const auto first = take_invitation(uploads, invitation_of_ben(uploads), now);
    const auto second = take_invitation(uploads, invitation_of_ben(uploads), now);
    ASSERT_TRUE(first && second);
    for (const auto& token : {other, *first, *second}) {
        EXPECT_TRUE(find_token(uploads, token, now));
    }
}

TEST(Invitation, IsRevokedWithTheTokenItGave) {
    auto uploads = new_uploads();
    const auto invitation = invitation_of_ben(uploads);
    const auto token = take_invitation(uploads, invitation, now);
    ASSERT_TRUE(token);
    EXPECT_EQ(revoke_tokens(uploads, find_token(uploads, *token, now)->id), 1U);
    EXPECT_FALSE(take_invitation(uploads, invitation, now));
}

TEST(Invitation, IsRevokedWithTheTokensOfItsName) {
    auto uploads = new_uploads();
    const auto invitation = invitation_of_ben(uploads);
    EXPECT_EQ(revoke_tokens(uploads, "ben"), 1U);
    EXPECT_FALSE(take_invitation(uploads, invitation, now));
}

} // namespace
} // namespace macadam::testing
