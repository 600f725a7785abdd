"""A bag of a robot that drives towards a wall, and label images of what its camera sees.

Usage: write_bag.py FOLDER; writes FOLDER/log.bag and FOLDER/labels/TIME.png. The ground is z = 0, the wall x = 8; LiDAR
and camera are 1.5 m above the ground, over the robot's origin.
"""
import math
import os
import struct
import sys
import zlib

import rosbag
import rospy
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import CameraInfo, Image, PointCloud2, PointField
from tf2_msgs.msg import TFMessage

HEIGHT, WALL = 1.5, 8.0
ROWS, COLS, FOCAL = 48, 64, 40.0
ROAD, BUILDING = 1, 13  # of config/classes/synthetic.yaml


def hit(x, direction):
    """Distance along a ray from the sensors' place, and the class that it meets; none: (None, 0)."""
    meets = []
    if direction[0] > 0:
        meets.append(((WALL - x) / direction[0], BUILDING))
    if direction[2] < 0:
        meets.append((HEIGHT / -direction[2], ROAD))
    return min(meets, default=(None, 0))


def header(message, stamp, frame):
    message.header.stamp = stamp
    message.header.frame_id = frame
    return message


def cloud(x, stamp):
    points = []
    for ring in range(-15, 10):
        for step in range(-40, 41):
            yaw, pitch = math.radians(step), math.radians(2 * ring)
            d = (math.cos(yaw) * math.cos(pitch), math.sin(yaw) * math.cos(pitch), math.sin(pitch))
            distance, _ = hit(x, d)
            if distance is not None and distance < 20:
                points.append(struct.pack("<3f", *(distance * c for c in d)))
    message = header(PointCloud2(), stamp, "lidar")
    message.height, message.width, message.point_step = 1, len(points), 12
    message.row_step = 12 * len(points)
    message.fields = [PointField(n, 4 * i, PointField.FLOAT32, 1) for i, n in enumerate("xyz")]
    message.data = b"".join(points)
    return message


def labels(x):
    """A row-major image of class ids; the camera looks ahead, x right and y down."""
    rays = (((1, -(u - COLS / 2) / FOCAL, -(v - ROWS / 2) / FOCAL)) for v in range(ROWS) for u in range(COLS))
    return bytes(hit(x, ray)[1] for ray in rays)


def png(gray):
    """A file of a row-major image."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    rows = b"".join(b"\0" + gray[COLS * row:COLS * (row + 1)] for row in range(ROWS))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", COLS, ROWS, 8, 0, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def write(folder):
    os.makedirs(os.path.join(folder, "labels"))
    with rosbag.Bag(os.path.join(folder, "log.bag"), "w") as bag:
        for i in range(8):
            stamp, x = rospy.Time(100 + i), 0.25 * i
            pose = header(Odometry(), stamp, "map")
            pose.pose.pose.position.x, pose.pose.pose.orientation.w = x, 1
            bag.write("/odom", pose, stamp)
            frame = header(TransformStamped(), stamp, "map")
            frame.child_frame_id = "base_link"
            frame.transform.translation.x, frame.transform.rotation.w = x, 1
            bag.write("/tf", TFMessage([frame]), stamp)
            image = header(Image(), stamp, "camera")
            image.height, image.width, image.encoding, image.step = ROWS, COLS, "mono8", COLS
            image.data = labels(x)
            bag.write("/camera/image", image, stamp)
            bag.write("/camera/camera_info", header(CameraInfo(height=ROWS, width=COLS), stamp, "camera"), stamp)
            bag.write("/lidar/points", cloud(x, stamp), stamp)
            with open(os.path.join(folder, "labels", f"{100 + i}.png"), "wb") as file:
                file.write(png(image.data))


if __name__ == "__main__":
    write(sys.argv[1])
