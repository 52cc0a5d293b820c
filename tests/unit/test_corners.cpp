// Boards drawn into pictures, whole and spoilt.
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "tools/calibrate/corners.hpp"

namespace
{

const calibrate::BoardSize board = {9, 6, 0.025};
const int square = 36; // px

// A chessboard of 9 x 6 inner corners with a white margin, the first of them at (110, 110).
cv::Mat picture_of_board()
{
	cv::Mat picture(480, 640, CV_8U, cv::Scalar(220));
	for (int row = 0; row <= board.rows; row++)
		for (int column = 0; column <= board.columns; column++)
			if ((row + column) % 2 == 0)
				cv::rectangle(
					picture,
					cv::Rect(110 + (column - 1) * square, 110 + (row - 1) * square, square, square),
					cv::Scalar(30), cv::FILLED);
	cv::GaussianBlur(picture, picture, {5, 5}, 0.8);
	return picture;
}

TEST(Corners, AreFoundRowByRowFromTheUpperLeft)
{
	const auto found = calibrate::find_board(picture_of_board(), board);
	ASSERT_EQ(found.corners.size(), 54u) << found.why;
	for (int i = 0; i < 54; i++) {
		EXPECT_NEAR(found.corners[static_cast<size_t>(i)].x, 109.5 + square * (i % 9), 0.1);
		EXPECT_NEAR(found.corners[static_cast<size_t>(i)].y, 109.5 + square * (i / 9), 0.1);
	}
}

// Half a turn shows other colours in the corner; the order stays that of the picture.
TEST(Corners, KeepTheirOrderWhenTheBoardIsUpsideDown)
{
	cv::Mat turned;
	cv::rotate(picture_of_board(), turned, cv::ROTATE_180);
	const auto found = calibrate::find_board(turned, board);
	ASSERT_EQ(found.corners.size(), 54u) << found.why;
	EXPECT_LT(found.corners[0].x, found.corners[8].x);
	EXPECT_LT(found.corners[0].y, found.corners[45].y);
}

// A board on its side may look the other way round to the second camera.
TEST(Corners, AreInTheSameOrderInBothPictures)
{
	auto left = calibrate::find_board(picture_of_board(), board).corners;
	auto right = left;
	std::reverse(right.begin(), right.end());
	calibrate::order_alike(left, board, right);
	EXPECT_EQ(left, right);
}

TEST(Corners, OfABoardThatIsCutOffAreLeftOut)
{
	cv::Mat picture = picture_of_board();
	picture.colRange(0, 200).setTo(128);
	const auto found = calibrate::find_board(picture, board);
	EXPECT_TRUE(found.corners.empty());
	EXPECT_NE(found.why.find("cut off"), std::string::npos) << found.why;
}

TEST(Corners, OfABlurredBoardAreLeftOut)
{
	cv::Mat picture = picture_of_board();
	cv::blur(picture, picture, {21, 1});
	const auto found = calibrate::find_board(picture, board);
	EXPECT_TRUE(found.corners.empty());
	EXPECT_NE(found.why.find("blur"), std::string::npos) << found.why;
}

TEST(Corners, OfABoardOfAnotherSizeAreLeftOut)
{
	for (const calibrate::BoardSize &wrong : {calibrate::BoardSize{8, 6, 0.025}, {9, 5, 0.025}, {10, 6, 0.025}}) {
		const auto found = calibrate::find_board(picture_of_board(), wrong);
		EXPECT_TRUE(found.corners.empty()) << wrong.columns << "x" << wrong.rows;
		EXPECT_FALSE(found.why.empty());
	}
}

TEST(Corners, AreNotFoundInAnEmptyPicture)
{
	const auto found = calibrate::find_board(cv::Mat(480, 640, CV_8U, cv::Scalar(90)), board);
	EXPECT_TRUE(found.corners.empty());
	EXPECT_NE(found.why.find("no board found"), std::string::npos) << found.why;
}

} // namespace
