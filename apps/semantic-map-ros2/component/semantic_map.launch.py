"""A container with the component: ros2 launch semantic_map_component semantic_map.launch.py points:=/velodyne_points params:=FILE"""
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import ComposableNodeContainer
from launch_ros.descriptions import ComposableNode


def generate_launch_description():
    node = ComposableNode(
        package="semantic_map_component", plugin="semantic_map_ros2::SemanticMapComponent", name="semantic_map",
        parameters=[LaunchConfiguration("params")], remappings=[("points", LaunchConfiguration("points"))],
        extra_arguments=[{"use_intra_process_comms": True}])
    return LaunchDescription([
        DeclareLaunchArgument("points", default_value="points", description="topic of labeled clouds"),
        DeclareLaunchArgument("params", description="parameters (YAML)"),
        ComposableNodeContainer(name="semantic_map_container", namespace="", package="rclcpp_components",
                                executable="component_container", composable_node_descriptions=[node])])
